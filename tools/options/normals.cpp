// SPDX-License-Identifier: Apache-2.0

#include "options/normals.h"

#include <algorithm>

#include <fmt/format.h>
#include <tex/format.h>

#include "cli/text.h"
#include "cli/usage_error.h"

namespace tex::cli {
namespace {

constexpr const char* kMeasured = "measured";
constexpr const char* kAutomatic = "auto";
constexpr const char* kRedOrAlpha = "rgorag";
constexpr const char* kLabPbr = "labpbr";

std::string guess_text(const std::string& layout) {
    // A grey picture with alpha has the texels of such a map with y in R, G and B.
    const std::string_view evidence =
        layout == "dxt5nm" ? " (A varies; R and B are constant, or R, G and B are equal)" : "";
    return fmt::format("layout not stated; guessed {} from the texels{}; --swizzle sets it", layout, evidence);
}

// The encoding of the same format. One with alpha is right for its format unless the file states that A is 1, and 8
// bits are widened by no container.
std::optional<Encoding> same_format(const SourceInfo& input) {
    const FormatInfo info = format_info(input.format);
    for (const auto& row : kEncodingNames) {
        const EncodingInfo encoding = encoding_info(row.value);
        if (encoding.format != input.format) continue;
        if (info.has_blocks() || info.channels == 2) return row.value;
        const bool has_x_there = input.swizzle[3] == Component::x, wants_x_there = encoding.swizzle[3] == Component::x;
        const bool is_widened = info.bits > 8 && input.swizzle[3] == Component::one;
        if (info.channels == 4 && has_x_there == wants_x_there && !is_widened) return row.value;
    }
    return std::nullopt;
}

Encoding exact_encoding(const SourceInfo& input) {
    const FormatInfo info = format_info(input.format);
    if (const auto same = same_format(input)) return *same;
    if (info.channels == 2 && info.sample == SampleKind::snorm) return info.bits == 8 ? Encoding::rg8 : Encoding::rg16;
    if (info.sample == SampleKind::floating) return info.bits == 16 ? Encoding::half : Encoding::float_;
    return info.bits == 16 ? Encoding::rgb16 : Encoding::rgb8;
}

// The name of an encoding that keeps alpha in such files, with the bits of the input if there is one; empty if there is
// none.
std::string_view alpha_encoding(const SourceInfo& input, Container container) {
    const FormatInfo info = format_info(input.format);
    std::string_view found;
    int best = 0;
    for (const auto& row : kEncodingNames) {
        if (!can_hold(row.value).alpha || !can_hold(container, row.value)) continue;
        const FormatInfo format = format_info(encoding_info(row.value).format);
        // Takes as many bits, or a few more; else the most.
        const int worth = (format.bits >= info.bits ? 1000 - format.bits : format.bits) +
                          (format.bits == info.bits && format.sample == info.sample ? 1 : 0);
        if (worth <= best) continue;
        best = worth;
        found = row.name;
    }
    return found;
}

// The layout of "abg", the channels of x, y and, if it is stored, z; or of "x=a,y=b,z=g", in any order.
std::optional<Swizzle> swizzle_of_channels(const std::string& text) {
    std::string letters = text;
    if (text.find('=') != std::string::npos) {
        letters = "---";
        for (const std::string& part : split(text, ',')) {
            const std::size_t place = part.size() == 3 && part[1] == '=' ? std::string_view("xyz").find(part[0]) : 3;
            if (place > 2 || letters[place] != '-') return std::nullopt;
            letters[place] = part[2];
        }
        if (letters[2] == '-') letters.pop_back();
    }
    if (letters.size() != 2 && letters.size() != 3) return std::nullopt;
    constexpr Component kComponents[] = {Component::x, Component::y, Component::z};
    Swizzle swizzle;
    swizzle.fill(Component::other);
    for (std::size_t k = 0; k < letters.size(); ++k) {
        const std::size_t channel = std::string_view("rgba").find(letters[k]);
        if (channel >= swizzle.size() || swizzle[channel] != Component::other) return std::nullopt;
        swizzle[channel] = kComponents[k];
    }
    return swizzle;
}

// The direction of "measured, else up", after the comma.
YAxis y_otherwise(const YIn& before, std::string_view text) {
    const std::size_t begin = std::min(text.find_first_not_of(' '), text.size());
    constexpr std::string_view kElse = "else ";
    const std::optional<YAxis> axis = text.substr(begin).starts_with(kElse)
                                          ? find_by_name(kYAxisNames, text.substr(begin + kElse.size()))
                                          : std::nullopt;
    if (before.axis || !axis)
        throw UsageError("of several words there are 'measured, else up' and 'measured, else down'");
    return *axis;
}

}  // namespace

Encoding encoding_of(const SourceInfo& input, const Task& task) {
    const std::optional<Container> before = container_of(task.map_path());
    const Encoding encoding = exact_encoding(input);
    if (before && can_hold_blocks(*before) == can_hold_blocks(task.container)) {
        if (can_hold(task.container, encoding)) return encoding;
        if (encoding == Encoding::rgba8 && can_hold(task.container, Encoding::rgb8)) return Encoding::rgb8;
    }
    return default_encoding(task.container);
}

void report_input(Job& job, const SourceInfo& info) {
    job.report["source"] = {{"format", name_of(kFormatNames, info.format)}, {"swizzle", layout_name(info.swizzle)}};
}

std::optional<Swizzle> parse_swizzle(const std::string& text, const std::vector<std::string>& more) {
    std::vector<std::string> names = names_of(words_of(kSwizzleNames));
    names.insert(names.end(), {kAutomatic, kLabPbr});
    names.insert(names.end(), more.begin(), more.end());
    const bool is_name = std::find(names.begin(), names.end(), text) != names.end();
    if (const auto channels = swizzle_of_channels(text); channels && !is_name) return channels;
    const std::string word = known_word(text, names);
    return word == kLabPbr ? kSwizzleXy : find_by_name(kSwizzleNames, word);
}

bool has_occlusion_in_blue(const std::string& swizzle) { return swizzle == kLabPbr; }

std::vector<Word> swizzle_words() {
    std::vector<Word> words = words_of(kSwizzleNames);
    words.insert(words.begin(), {kAutomatic, "as the file says, else guessed from the texels"});
    words.push_back({kLabPbr, "as rg: x in R, y in G, occlusion in B and height in A (Minecraft)"});
    return words;
}

void add_length_in(Command& command, std::optional<LengthIn>& length_in) {
    command.choice(length_in, "--length-in", "WHAT", kLengthInNames, "what the lengths of vectors in the input hold")
        .preset = "nothing: they are 1";
}

Option& add_y_in(Command& command, const char* name, std::string help, std::function<void(YIn)> set) {
    Option& y = command.option(name, "AXIS", std::move(help), [set = std::move(set)](const std::string& text) {
        std::vector<std::string> names = names_of(words_of(kYAxisNames));
        names.emplace_back(kMeasured);
        const std::size_t comma = text.find(',');
        YIn given{find_by_name(kYAxisNames, known_word(text.substr(0, comma), names)), {}};
        if (comma != std::string::npos) given.otherwise = y_otherwise(given, text.substr(comma + 1));
        set(given);
    });
    y.words = words_of(kYAxisNames);
    y.words.push_back({kMeasured,
                       "as the texels show; an error if they do not show it clearly, but for \"measured, else up\" and "
                       "\"measured, else down\""});
    y.completes = Completes::words;
    return y;
}

void NormalsReader::add(Command& command, bool with_keep_length, bool keeps_extras) {
    keeps_extras_ = keeps_extras;
    command.group("Input");
    add_y_in(command, "--y-in", "which way green points in the input",
             [this](YIn y) {
                 measures_y = !y.axis;
                 y_otherwise = y.otherwise;
                 unpack.y_axis = y.axis;
             })
        .often(6, "which way green points in the input: up or down")
        .preset = "as the file says, else up";
    Option& row =
        command.option("--swizzle", "S", "which channels hold what: a word, or the channels of x, y and z, such as abg",
                       [this](const std::string& text) {
                           swizzle = parse_swizzle(text, {kRedOrAlpha});
                           rg_or_ag = text == kRedOrAlpha;
                       });
    row.words = swizzle_words();
    row.words.push_back({kRedOrAlpha, "x in R or A, whichever varies, y in G: R * A in a shader"});
    row.preset = "auto";
    row.completes = Completes::words;
    command.choice(bc5_order, "--bc5-order", "ORDER", kBc5OrderNames, "the channels of BC5 files that do not say")
        .preset = "as the texels of ATI2 show, else xy";
    command.choice(unpack.range, "--range", "R", kValueRangeNames, "how stored floats are read");
    command.flag(unpack.snap_flat, "--snap-flat", "read 127 and 128 of 8-bit files as 0");
    command.flag(fills_background, "--fill-background", "fill the background around charts with the nearest normals");
    if (with_keep_length) command.flag(unpack.keep_length, "--keep-length", "do not normalise what is read");
    if (!keeps_extras) return;
    add_length_in(command, length_in);
    command.check([this] {
        if (length_in && unpack.keep_length) throw UsageError("--length-in and --keep-length exclude each other");
    });
    command.flag(drops_extras, "--drop", "leave out channels that hold no normals, and do not warn of it");
}

SourceOptions NormalsReader::options(const Job& job, const Reading& reading) const {
    SourceOptions options;
    options.read = job.read_options;
    options.unpack = unpack;
    options.unpack.swizzle = swizzle;
    if (reading.y) options.unpack.y_axis = reading.y->axis;
    options.measure_y = reading.y ? !reading.y->axis : measures_y;
    options.y_otherwise = reading.y ? reading.y->otherwise : y_otherwise;
    options.unpack.keep_length = reading.keep_length.value_or(unpack.keep_length);
    if (bc5_order) options.bc5_swizzle = *bc5_order == Bc5Order::xy ? kSwizzleXy : kSwizzleYx;
    options.r_or_a = rg_or_ag;
    options.doubt_y = reading.doubt_y;
    options.inspect = !reading.object;
    options.unpack.others.length = length_in == LengthIn::occlusion;
    if (reading.extras) options.unpack.others = *reading.extras;
    options.drop_others = drops_extras || !keeps_extras_;
    options.fill_background = fills_background;
    options.file_y_first = reading.is_detail && !reading.y;
    return options;
}

void NormalsReader::note(Job& job, const std::string& path, const SourceInfo& info) {
    for (const std::string& remark : info.remarks) job.warn(remark, path);
    if (info.srgb) job.warn("declares sRGB colours, which normals are not; its values are used as they are", path);
    if (info.order_assumed) {
        job.warn(
            "its FourCC ATI2 leaves open whether x or y comes first, and its texels do not show it; x is taken to be "
            "first, --bc5-order yx reads y first",
            path);
    }
    if (info.y_doubtful && info.y_known) {
        job.warn(fmt::format("green is stated to point {}, but the texels show the other direction; say measured, and "
                             "they decide",
                             name_of(kYAxisNames, info.y_axis)),
                 path);
    } else if (info.y_doubtful) {
        job.warn(fmt::format("green is taken to point {}, but the texels show the other direction; {} sets it",
                             name_of(kYAxisNames, info.y_axis),
                             path == job.task.map_path() ? "--y-in" : "--y-in, or --detail-y-in for a detail,"),
                 path);
    }
    if (info.not_finite > 0) {
        job.warn(fmt::format("{} texels are NaN or infinite, and become flat", info.not_finite), path);
    }
    if (info.z01) {
        job.warn(
            "z is stored as it is, from 0 to 1, and not as (z + 1) / 2: vectors have unit length that way alone, and "
            "are read so (--range unsigned: the usual way)",
            path);
    }
    if (!warn_of_kind(job, path, info)) return;
    if (path == job.task.map_path() && !info.others.empty()) warn_of_extras(job, path, info);
    if (info.guessed) guesses_.add(job, path, guess_text(layout_name(info.swizzle)));
}

std::optional<JudgedPicture> NormalsReader::judged(const Job& job, const std::string& path,
                                                   const SourceInfo& info) const {
    constexpr double kMostly = 0.5;  // of a map that is mostly background, the background may be the picture
    const bool is_guessed = info.guessed && !format_info(info.format).has_blocks();  // grey and alpha, say
    const bool raises_doubt =
        info.object_space || (!length_in && (info.z_doubtful || info.background > kMostly || is_guessed));
    // check-normals reads the file as it states, not as options say.
    const bool is_as_stated = !swizzle && unpack.range == ValueRange::automatic;
    if (!raises_doubt || !is_as_stated || job.task.model) return std::nullopt;
    return judge_picture(path, job.read_options);
}

Result<void> NormalsReader::accept(const Job& job, const std::string& path, const SourceInfo& info) const {
    const std::optional<JudgedPicture> picture = judged(job, path, info);
    if (!picture || !picture->is_no_map) return {};
    return Error{ErrorCode::bad_data, path, no_map_text(*picture) + kTakeAny};
}

bool NormalsReader::warn_of_kind(Job& job, const std::string& path, const SourceInfo& info) const {
    // Encoders of these leave lengths as they come.
    const bool has_free_lengths = info.format == Format::bc7_unorm || info.format == Format::uastc_4x4_unorm;
    const bool doubts_z = info.z_doubtful && !length_in && !has_free_lengths;
    JudgedPicture unjudged;
    unjudged.is_object_space = info.object_space && !info.z_doubtful;
    const JudgedPicture judged = this->judged(job, path, info).value_or(unjudged);
    const bool has_background = info.background > 0.0 || judged.has_background;
    if (judged.is_no_map) {
        job.warn(no_map_text(judged), path);
        return false;
    }
    if (judged.is_object_space) {
        job.warn(
            "its vectors face all directions, as in object space, and are read as tangent space; "
            "convert-normals --from object --mesh FILE converts it",
            path);
    } else if (judged.is_inverted) {
        job.warn(
            "its vectors point into the surface: blue, or the whole picture, was inverted; invert it back in an image "
            "editor, or, if it was blue alone, let --swizzle rg make z from x and y",
            path);
    } else if (judged.is_x_ray) {
        job.warn(
            "x, y and z are in A, B and G, as in the X-Ray engine, but R, G and B are read; --swizzle abg is right",
            path);
    } else if (judged.is_other_blue && names_layout(judged)) {
        job.warn("these are hardly normals: " + judged.words, path);
    } else if (judged.is_damaged) {
        job.warn("its values are not as they were: " + judged.words + "; repair-normals mends that", path);
    } else if (judged.is_subsampled && doubts_z) {
        job.warn(
            "its colours have half the resolution of lightness, as JPEG and lossy WebP store them, and with them "
            "the finest bumps; take it from a lossless source",
            path);
    } else if (judged.is_uneven && doubts_z) {
        job.warn("its vectors are not of unit length: " + judged.words +
                     "; pack-normals --normalize makes them so, and if blue holds other data, such as occlusion, "
                     "--swizzle rg makes z from x and y",
                 path);
    } else if (doubts_z && !has_background) {
        job.warn(
            "blue is not the z of its red and green: it seems to hold other data, such as occlusion or heights; "
            "--swizzle rg (x in R, y in G) leaves it out and makes z from x and y",
            path);
    }
    if (has_background && warns_of_background) {
        job.warn(fmt::format("{:.0f} % of its texels look like background (black, grey or white), which smaller levels "
                             "and block compression mix into the charts; --fill-background fills it",
                             std::max(1.0, 100.0 * info.background)),
                 path);
    }
    return true;
}

// Says which channels an output lacks.
void NormalsReader::warn_of_extras(Job& job, const std::string& path, const SourceInfo& info) const {
    std::vector<std::string> names;
    for (const ExtraChannel& other : info.others) {
        const std::string name = other.name == 'L' ? "the lengths of vectors" : std::string(1, other.name);
        names.push_back(fmt::format("{} ({:.2g} to {:.2g})", name, other.least, other.greatest));
    }
    const bool is_alpha = std::any_of(info.others.begin(), info.others.end(),
                                      [](const ExtraChannel& other) { return other.name == 'A'; });
    const std::string_view keeps = is_alpha ? alpha_encoding(info, job.task.container) : std::string_view();
    const bool is_one = names.size() == 1;
    job.warn(fmt::format("{} {} data beside the normals, which {} left out ({}--drop silences this warning)",
                         join(names, " and "), is_one && names[0].front() != 't' ? "holds" : "hold",
                         is_one ? "is" : "are", keeps.empty() ? "" : fmt::format("--format {} keeps A; ", keeps)),
             path);
}

Result<Source> NormalsReader::read(Job& job, const std::string& path, const Execution& execution,
                                   const Reading& reading) {
    SourceOptions with = options(job, reading);
    if (reading.model != nullptr) {
        if (auto opened = reading.model->open(with.read); !opened) return opened.error();
    }
    auto source = read_normals(path, with, reading.base_only, execution);
    if (source && reading.holds) {
        const ExtraSet held = reading.holds(source->info);
        std::erase_if(source->info.others, [&held](const ExtraChannel& extra) { return extra.is_in(held); });
    }
    if (source) note(job, path, source->info);
    return source;
}

Result<Source> NormalsReader::read(Job& job, double until, bool base_only) {
    auto source = read(job, job.task.input, job.until(until), {base_only});
    if (source) report_input(job, source->info);
    return source;
}

}  // namespace tex::cli
