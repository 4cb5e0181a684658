// SPDX-License-Identifier: Apache-2.0

#include "options/output.h"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <iterator>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "cli/foreign_words.h"
#include "cli/text.h"
#include "cli/usage_error.h"
#include "cli/value.h"
#include "fields/file_fields.h"
#include "fields/pack_fields.h"
#include "files/path_names.h"
#include "tasks/job.h"
#include "tasks/name_pattern.h"

namespace tex::cli {
namespace {

std::string known_extensions() {
    std::vector<std::string> names;
    for (const Named<Container>& row : kContainerNames) names.emplace_back(row.meaning);
    return join(names);
}

std::string encodings_in(Container container) {
    std::vector<std::string> names;
    for (const Named<Encoding>& row : kEncodingNames) {
        if (can_hold(container, row.value)) names.emplace_back(row.name);
    }
    return join(names);
}

std::string containers_for(Encoding encoding) {
    std::vector<std::string> names;
    for (const Named<Container>& row : kContainerNames) {
        if (can_hold(row.value, encoding)) names.emplace_back(row.meaning);
    }
    return join(names);
}

constexpr const char* kKeep = "keep";
constexpr int kDefaultZstd = 9;

// "zstd", "zstd:LEVEL" or "none".
int parse_zstd(const std::string& text) {
    if (text == "none") return 0;
    const auto [scheme, level] = cut(text, ':');
    int number = kDefaultZstd;
    if (text.find(':') != std::string::npos) {
        const auto [end, error] = std::from_chars(level.data(), level.data() + level.size(), number);
        if (error != std::errc() || end != level.data() + level.size()) number = 0;
    }
    if (scheme == "zstd" && number >= 1 && number <= kHighestZstdLevel) return number;
    throw UsageError(
        fmt::format("'{}' is not zstd, zstd:N with N from 1 to {}, or none", printable(text), kHighestZstdLevel));
}

}  // namespace

std::string default_encodings(Encoding of_textures) {
    std::string text;
    for (const Named<Encoding>& encoding : kEncodingNames) {
        std::vector<std::string> containers;
        for (const Named<Container>& container : kContainerNames) {
            Encoding held = default_encoding(container.value);
            if (held == default_encoding(Container::dds)) held = of_textures;
            if (held == encoding.value) containers.emplace_back(container.name);
        }
        if (!containers.empty())
            text += fmt::format("{}{} in {}", text.empty() ? "" : "; ", encoding.name, join(containers));
    }
    return text;
}

void OutputOptions::add(Command& command, std::string format_default, std::string y_default, bool with_keep,
                        Container standard_output) {
    command.group("Output");
    add_format(command, std::move(format_default), with_keep);
    command
        .choice(container, "--container", "TYPE", kContainerNames,
                "the file type, if the output's name does not say it (a pipe)")
        .preset = fmt::format("by extension; {} for -", name_of(kContainerNames, standard_output));
    command.choice(y, "--y", "AXIS", kYAxisNames, "which way green points in the output")
        .often(7, "which way green points in the output: up or down")
        .preset = std::move(y_default);
    command.choice(effort, "--effort", "E", kEffortNames, "how hard block encoders search for the smallest error");
    command.choice(metric, "--metric", "M", kMetricNames, "the error that --effort best minimises; angle implies best");
    add_rdo(command);
    command.choice(dds_header, "--dds-header", "H", kDdsHeaderNames, "the header of DDS files");
    command.flag(dds_mark, "--dds-mark", "mark DDS files as normal maps, as NVIDIA's tools do");
    command
        .option("--supercompress", "zstd[:N]", "compress the levels of KTX2 files; N is from 1 (fast) to 22 (small)",
                [this](const std::string& text) { zstd = parse_zstd(text); })
        .preset = "zstd for uastc and uastc-rrrg; else none";
    command
        .option("--quality", "N", "the quality of JPEG files, from 1 (small) to 100",
                [this](const std::string& text) { quality = parse_int(text, range_of(&WriteOptions::jpeg_quality)); })
        .preset = std::to_string(WriteOptions{}.jpeg_quality);
}

void OutputOptions::add_format(Command& command, std::string preset, bool with_keep) {
    std::vector<Word> words = words_of(kEncodingNames);
    if (with_keep) words.push_back({kKeep, "that of each input, if the file type can hold it"});
    Option& row = command.option("--format", "F", "how normals are stored",
                                 [this, valid = names_of(words)](const std::string& text) {
                                     format = find_by_name(kEncodingNames, known_word(text, valid));
                                     keeps_format = !format;
                                 });
    row.often(3, "how normals are stored: dxt5nm, bc5, rgb8 ...").preset = std::move(preset);
    row.words = std::move(words);
    row.completes = Completes::words;
}

void OutputOptions::add_rdo(Command& command) {
    constexpr Range kAngle{0.0, 180.0, false};
    command
        .number(rdo.mean, "--rdo-mean", "DEG", kAngle,
                "choose blocks that compress better; the mean angle grows by at most DEG")
        .preset = "off";
    command.number(rdo.max, "--rdo-max", "DEG", kAngle, "with --rdo-mean, no texel's angle grows beyond DEG").preset =
        "four times the mean";
    command.number(rdo.window, "--rdo-window", "BYTES", range_of(&RdoOptions::window),
                   "how far back --rdo-mean looks for what a block can copy");
    command.check([this, &command] {
        const std::vector<std::string> more = command.given_of({"--rdo-max", "--rdo-window"});
        if (rdo.mean == 0.0f && !more.empty()) throw UsageError(fmt::format("{} needs --rdo-mean", more.front()));
        if (rdo.mean > 0.0f && format && !can_optimise(*format))
            throw UsageError("--rdo-mean needs --format to be one of " +
                             join(names_of(words_of(kEncodingNames, can_optimise))));
    });
}

void OutputOptions::add_engines(Command& command) {
    Option& row =
        command.option("--for", "ENGINE[,ENGINE]", "file type, format, y and levels as the engine imports them",
                       [this, &command](const std::string& text) {
                           if (text == "list")
                               command.answer(engine_table());
                           else
                               engines = parse_engines(text);
                       });
    row.often(5, "what an engine wants: unity, unreal, godot ...").words = engine_words();
    row.completes = Completes::words;
}

OutputOptions OutputOptions::of(const Engine* its_engine) const {
    OutputOptions options = *this;
    options.engine = its_engine;
    if (its_engine == nullptr) return options;
    if (!format && !keeps_format) options.format = its_engine->format;
    if (!y) options.y = its_engine->y;
    return options;
}

std::vector<const Engine*> OutputOptions::engines_or_none() const {
    return engines.empty() ? std::vector<const Engine*>{nullptr} : engines;
}

std::optional<Container> OutputOptions::made_container() const {
    return container || engine == nullptr ? container : engine->container;
}

void OutputOptions::fill(NameFields& fields) const {
    if (format) fields.format = name_of(kEncodingNames, *format);
    if (engine != nullptr) fields.engine = engine->name;
    if (const auto made = made_container()) fields.type = extension_of(*made).substr(1);
}

Container OutputOptions::container_for(const std::string& output, Container standard_output) const {
    const Container chosen = container_of_output(output, standard_output);
    if (zstd.value_or(0) != 0 && !can_compress(chosen))
        throw UsageError(printable(output), "--supercompress needs a KTX2 file");
    if (rdo.mean > 0.0f && !can_hold(chosen, Encoding::dxt5nm) && !can_hold(chosen, Encoding::astc_4x4))
        throw UsageError(printable(output), "--rdo-mean needs a DDS, KTX2 or ASTC file");
    if (quality && chosen != Container::jpeg)
        throw UsageError("--quality", "needs a JPEG file; WebP is written without loss, and of blocks it is --effort");
    return chosen;
}

Container OutputOptions::container_of_output(const std::string& output, Container standard_output) const {
    const std::optional<Container> named = container_of(output);
    if (container) {
        if (named && *named != *container) {
            throw UsageError(fmt::format("{} says {}, --container says {}", printable(output),
                                         name_of(kContainerNames, *named), name_of(kContainerNames, *container)));
        }
        return *container;
    }
    if (named) return *named;
    if (output == "-") return made_container().value_or(standard_output);
    const std::string extension = slashed(std::filesystem::path(output).extension());
    const std::string what = extension.empty() ? "a name without an extension"
                                               : fmt::format("unsupported output format '{}'", printable(extension));
    throw UsageError(printable(output),
                     fmt::format("{}; it must be one of {}, or give --container{}", what, known_extensions(),
                                 extension.empty() ? "" : unwritten_type_answer(extension.substr(1))));
}

void OutputOptions::check_knows_format() const {
    if (keeps_format) throw UsageError("{format} in a name needs a --format other than keep");
}

void OutputOptions::check_holds(const std::string& output, Container container, Encoding encoding) {
    if (can_hold(container, encoding)) return;
    throw UsageError(printable(output),
                     fmt::format("{} files cannot hold {}, they hold {}; {} goes into {}",
                                 name_of(kContainerNames, container), name_of(kEncodingNames, encoding),
                                 encodings_in(container), name_of(kEncodingNames, encoding), containers_for(encoding)));
}

int OutputOptions::zstd_for(Format stored) const {
    return zstd.value_or(stored == Format::uastc_4x4_unorm ? kDefaultZstd : 0);
}

WriteOptions OutputOptions::write_options(const Job& job) const {
    WriteOptions write = job.write_options;
    write.dds_header = dds_header;
    write.dds_mark = dds_mark;
    write.zstd = format ? zstd_for(encoding_info(*format).format) : zstd.value_or(write.zstd);
    write.jpeg_quality = quality.value_or(write.jpeg_quality);
    return write;
}

void report_texture(Job& job, Extent extent, int levels, const PackOptions& pack, std::size_t bytes,
                    const std::optional<RdoReport>& rdo) {
    job.report["extent"] = {extent.width, extent.height};
    job.report["levels"] = levels;
    job.report["format"] = name_of(kEncodingNames, pack.encoding);
    job.report["y"] = nullptr;
    if (pack.y_known) job.report["y"] = name_of(kYAxisNames, pack.y_axis);
    job.report["bytes"] = bytes;
    if (rdo) {
        job.report["rdo"] = {{"plain_mean", rdo->plain_mean},
                             {"mean", rdo->mean},
                             {"most_growth", rdo->most_growth},
                             {"most_raised", rdo->most_raised}};
    }
    const Engine* const engine = job.task.engine;
    if (engine == nullptr) return;
    job.report["for"] = engine->name;
    // The preset of an importer that compresses, in a file that the engine would load as it is.
    const bool is_odd = can_hold_blocks(job.task.container) && !can_hold_blocks(engine->container);
    if (is_odd && pack.encoding == engine->format) {
        job.warn(
            fmt::format("--for {0} is meant for {1} files; this {2} file holds {3}, "
                        "which is not compressed: name it {1}, or choose a --format",
                        engine->name, extension_of(engine->container), extension_of(job.task.container),
                        name_of(kEncodingNames, pack.encoding)));
    }
}

}  // namespace tex::cli
