// SPDX-License-Identifier: Apache-2.0

#include "options/heights.h"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <system_error>

#include <fmt/format.h>
#include <tex/file.h>

#include "cli/foreign_words.h"
#include "cli/text.h"
#include "cli/usage_error.h"
#include "fields/bake_fields.h"
#include "fields/height_fields.h"
#include "options/input_kind.h"
#include "tasks/other_parts.h"

namespace tex::cli {

void ColorGroup::add(Command& command) {
    command.text(color.space, "--color-space", "NAME",
                 "the colour space of the file's heights, which become linear; without a configuration, sRGB or "
                 "linear");
    Option& config = command.text(color.config, "--ocio-config", "FILE", "the OpenColorIO configuration");
    config.preset = "$OCIO";
    config.completes = Completes::files;
    command.check([this, &command] {
        if (command.given("--ocio-config") && color.space.empty())
            throw UsageError("--ocio-config does nothing without --color-space");
    });
}

ColorOptions ColorGroup::options() const {
    ColorOptions with = color;
    if (const char* variable = std::getenv("OCIO"); variable != nullptr && with.config.empty()) with.config = variable;
    return with;
}

Result<void> ColorGroup::check() const {
    if (!is_given()) return {};
    Image texel;
    texel.planes.emplace_back(Extent{1, 1}, 0.5f);
    texel.names = {"Y"};
    const auto converted = to_linear(std::move(texel), options());
    if (!converted && converted.error().code == ErrorCode::bad_option) {
        throw UsageError("--color-space", fmt::format("{}", converted.error().reason));
    }
    if (!converted) return converted.error();
    return {};
}

std::vector<std::string> ColorGroup::files() const {
    if (!is_given()) return {};
    auto files = color_files(options());
    if (files) return std::move(*files);
    // The error is reported by check().
    const std::string config = options().config;
    return config.empty() || config.starts_with("ocio://") ? std::vector<std::string>() : std::vector{config};
}

void StrengthOptions::add(Command& command, bool can_measure) {
    command.group("Strength (one of three)");
    const std::string help = "the height of value 1.0 in texels, as a shader measures it; negative: dents";
    const std::vector<std::string> rivals = {"--height-range", "--uv-height"};
    const std::string brief = "the height of value 1.0 in texels";
    if (can_measure) {
        Option& row = command.option("--bumpiness", "B", help + "; or a word", [this](const std::string& text) {
            measured = text == "auto";
            if (!measured) bumpiness = parse_float(text);
        });
        row.words = {{"auto", "what makes the 99th percentile of the slopes 45 degrees; it is printed"}};
        row.preset = fmt::format("as the file states, else {}", bumpiness);
        row.often(1, brief + ", or auto").completes = Completes::words;
        row.rivals = rivals;
    } else {
        command.number(bumpiness, "--bumpiness", "B", {}, help).often(1, brief).rivals = rivals;
    }
    command.option("--height-range", "R", "the height of value 1.0 in the unit of --world-size",
                   [this](const std::string& text) { height_range = parse_double(text); });
    command.option("--world-size", "W[xH]", "the width and height of the whole map; without H, texels are square",
                   [this](const std::string& text) {
                       const auto [first, second] = cut(text, 'x');
                       width = parse_double(first, kPositive);
                       height = text.find('x') == std::string::npos ? 0.0 : parse_double(second, kPositive);
                   });
    command.option("--uv-height", "R", "the height of value 1.0 in widths of the map",
                   [this](const std::string& text) { uv_height = parse_double(text); });
    if (can_measure) {
        command
            .number(vertical_scale, "--vertical-scale", "S", {},
                    "make slopes S times as steep, also those of the ground")
            .preset = "1";
    }
    command.check([this, &command] {
        const std::vector<std::string> several = command.given_of({"--bumpiness", "--height-range", "--uv-height"});
        is_given = !several.empty();
        if (several.size() > 1) throw UsageError(join(several, " and ") + " contradict each other: give one");
        if (command.given("--world-size") && !height_range)
            throw UsageError("--world-size does nothing without --height-range, which is 1 where heights are metres");
        if (height_range && !command.given("--world-size")) throw UsageError("--height-range needs --world-size");
        if (measured && vertical_scale != 1.0f)
            throw UsageError("--vertical-scale contradicts --bumpiness auto: give one");
    });
}

std::string StrengthOptions::given_name() const {
    if (!is_given) return {};
    return height_range ? "--world-size" : uv_height ? "--uv-height" : "--bumpiness";
}

Strength StrengthOptions::strength(Extent extent) const {
    if (height_range) return strength_from_world(extent, *height_range, width, height).value();
    if (uv_height) return strength_from_uv(extent, *uv_height).value();
    return {bumpiness, bumpiness};
}

void KernelOption::add(Command& command, std::string help) {
    Option& row = command.option("--kernel", "K", std::move(help), [this](const std::string& text) {
        const auto [name, sigma] = cut(text, ':');
        bake.kernel = parse_word(name, kGradientKernelNames);
        if (text.find(':') == std::string::npos) return;
        if (bake.kernel != GradientKernel::gaussian) {
            throw UsageError(fmt::format("{} takes no sigma, only gaussian does", name));
        }
        bake.gaussian_sigma = parse_float(sigma, range_of(&BakeOptions::gaussian_sigma));
    });
    row.words = words_of(kGradientKernelNames);
    row.completes = Completes::words;
    row.preset = name_of(kGradientKernelNames, bake.kernel);
    row.help += fmt::format("; gaussian:SIGMA sets its width in texels (default {})", bake.gaussian_sigma);
}

void HeightGroup::add(Command& command) {
    Option& channel =
        command.option("--channel", "C", "which channel holds the heights, also by its name in an EXR file",
                       [this](const std::string& text) {
                           const auto known = find_by_name(kHeightChannelNames, text);
                           if (text.empty()) throw UsageError("needs a value that is not empty");
                           options.channel = known.value_or(HeightChannel::automatic);
                           options.channel_name = known ? std::string() : text;
                       });
    channel.words = words_of(kHeightChannelNames);
    channel.completes = Completes::words;
    channel.preset = name_of(kHeightChannelNames, options.channel);
    command.choice(values, "--heights", "WHAT", kFileValuesNames, "what integers in the file become");
    command.option("--raw", "LAYOUT", "the file is bare heights: [WxH,]TYPE[,SKIP], such as 1025x1025,u16le",
                   [this](const std::string& text) {
                       if (const auto sound = check_raw(text); !sound || text.empty())
                           throw UsageError(sound ? "needs a value that is not empty" : sound.error().reason);
                       raw = text;
                   });
    command.flag(options.invert, "--invert", "white is low: h becomes 1 - h");
    command.choice(options.deband, "--deband", "WHEN", kDebandNames,
                   "regain the bits that rounding to 8 bits took away; see the manual page");
    command.number(options.blur_sigma, "--blur", "SIGMA", range_of(&HeightOptions::blur_sigma),
                   "blur the heights first, by a Gaussian of SIGMA texels");
    command.flag(options.fill_invalid, "--fill-invalid",
                 "replace NaN, infinite and no-data texels by the nearest valid one");
    command.option("--no-data", "V",
                   "texels for which the file stores this value are invalid; none ignores the value that a TIFF names",
                   [this](const std::string& text) {
                       options.no_data = text == "none" ? std::numeric_limits<float>::quiet_NaN() : parse_float(text);
                   });
}

void note_deband(Job& job, const DebandReport& report, Deband when, const std::string& file) {
    job.report["deband"] = {{"applied", report.applied},
                            {"step", report.step},
                            {"codes", report.codes},
                            {"terrace_texels", report.terrace_texels}};
    if (when == Deband::on && !report.applied)
        job.warn("--deband on changes nothing: the heights lie on no common steps coarser than 12 bits", file);
}

ChannelFile parse_channel_file(const std::string& text) {
    if (text.empty()) throw UsageError("needs a value that is not empty");
    ChannelFile source{text};
    if (const std::size_t colon = text.rfind(':'); colon != std::string::npos) {
        const auto channel = find_by_name(kHeightChannelNames, common_word(text.substr(colon + 1)));
        if (!channel) return source;  // the colon is part of the file's name
        source.channel = *channel;
        source.file.resize(colon);
    }
    return source;
}

namespace {

Result<Image> read_unit_values(Job& job, const std::string& file) {
    ReadOptions read = job.read_options;
    read.values = FileValues::unit;
    return read_image(file, read);
}

Result<Plane<float>> channel_of(const Image& image, const ChannelFile& source, const Execution& execution) {
    HeightOptions channel;
    channel.channel = source.channel;
    channel.no_data = std::numeric_limits<float>::quiet_NaN();
    auto values = height_field(image, channel, execution);
    if (!values) return values.error().of(source.file);
    return std::move(values->height);
}

}  // namespace

Result<Plane<float>> read_channel(Job& job, const ChannelFile& source, const Execution& execution) {
    const auto image = read_unit_values(job, source.file);
    return image ? channel_of(*image, source, execution) : Result<Plane<float>>(image.error());
}

Result<Plane<float>> read_only_channel(Job& job, const ChannelFile& source, const std::string& advice) {
    const Execution execution{job.threads(), {}};
    const auto image = read_unit_values(job, source.file);
    if (!image) return image.error();
    if (source.channel != HeightChannel::automatic || image->planes.size() < 3)
        return channel_of(*image, source, execution);
    constexpr float kGrey = 8.5f / 255.0f;  // how far blocks of BC1 and lossy pictures move grey
    std::string ranges;
    bool differ = false;
    for (std::size_t c = 0; c < 3; ++c) {
        float least = 1.0f, most = 0.0f;
        for (int j = 0; j < image->extent().height; ++j) {
            for (int i = 0; i < image->extent().width; ++i) {
                const float value = image->planes[c].at(i, j);
                least = std::min(least, value);
                most = std::max(most, value);
                differ = differ || !(std::abs(value - image->planes[1].at(i, j)) <= kGrey);
            }
        }
        ranges += fmt::format("{}{} is {:.2f} to {:.2f}", c == 0 ? "" : ", ", "RGB"[c], least, most);
    }
    if (!differ) return channel_of(*image, {source.file, HeightChannel::g}, execution);
    return Error{ErrorCode::bad_data, source.file, fmt::format("its channels differ ({}): {}", ranges, advice)};
}

void HeightReader::add_header_file(Task& task) {
    for (std::string& part : other_parts(task.input, task.input)) task.own.push_back(std::move(part));
}

Error HeightReader::with_remedy(const Error& error) {
    if (error.detail != ErrorDetail::missing_heights) return error;
    return {error.code, error.file, error.reason + "; --fill-invalid fills in the nearest valid ones"};
}

namespace {

constexpr const char* kStoredText =
    "by its type and tags the file holds quantities, such as metres, and they are used as they are stored; --heights "
    "unit reads the whole range of the type as 0 to 1";

void note_implausible(Job& job, std::int64_t texels, HeightChannel channel) {
    const auto name = name_of(kHeightChannelNames, channel);
    if (channel != HeightChannel::rg16 && channel != HeightChannel::gr16) {
        return job.warn(
            fmt::format("{} heights are below -12000 m or above 9000 m: is the picture really {}?", texels, name));
    }
    job.report["grey_texels"] = texels;
}

std::string luma_text(std::int64_t texels) {
    return fmt::format(
        "R, G and B differ in {} texels: their luma is the height; --channel chooses another, and terrain-rgb or "
        "terrarium for map tiles",
        texels);
}

}  // namespace

Result<void> HeightReader::accept(const Job& job) const {
    if (heights.options.channel != HeightChannel::automatic) return {};
    const JudgedColours judged = judge_colours(job.task.input, job.read_options);
    if (judged.words.empty()) return {};
    return Error{ErrorCode::bad_data, job.task.input, judged.words + kTakeAny};
}

JudgedColours HeightReader::judge(const Job& job, const HeightReport& report) const {
    const bool is_asked_for = heights.options.channel != HeightChannel::automatic;
    return report.luma_texels == 0 || is_asked_for ? JudgedColours() : judge_colours(job.task.input, job.read_options);
}

void HeightReader::note(Job& job, const HeightReport& report, const JudgedColours& judged) {
    if (heights.options.deband != Deband::off) note_deband(job, report.deband, heights.options.deband);
    job.report["heights"] = name_of(kFileValuesNames, report.stored ? FileValues::stored : FileValues::unit);
    if (!report.remark.empty()) job.warn(report.remark);
    if (report.implausible_texels > 0)
        note_implausible(job, report.implausible_texels, judged.channel.value_or(heights.options.channel));
    const bool chose_stored = report.stored && heights.values == FileValues::automatic;
    if (chose_stored) job.remark(kStoredText);
    const bool takes_luma = report.luma_texels > 0 && judged.words.empty();
    if (report.luma_texels > 0 && !takes_luma) job.warn(judged.words);
    if (takes_luma) job.remark(luma_text(report.luma_texels));
    const std::lock_guard lock(mutex_);
    if (chose_stored) stored_.add(job.task.input);
    if (!takes_luma) return;
    luma_.add(job.task.input);
    luma_texels_ += report.luma_texels;
}

std::string HeightReader::FileCount::text() const {
    return files > 1 ? fmt::format("{} and {} more", first, files - 1) : first;
}

void HeightReader::warn_of_files(Console& console) const {
    if (stored_.files > 0) console.warning(fmt::format("{}: {}", stored_.text(), kStoredText));
    if (luma_.files > 0) console.warning(fmt::format("{}: {}", luma_.text(), luma_text(luma_texels_)));
}

}  // namespace tex::cli
