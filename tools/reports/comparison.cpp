// SPDX-License-Identifier: Apache-2.0

#include "reports/comparison.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <tex/check.h>
#include <tex/file.h>
#include <tex/preview.h>

#include "cli/json.h"
#include "cli/text.h"
#include "cli/text_file.h"
#include "cli/usage_error.h"
#include "tasks/collisions.h"
#include "tasks/depfile.h"

namespace tex::cli {
namespace {

Json json_of(const std::vector<std::string>& inputs) {
    Json line;
    line["a"] = inputs[0];
    if (inputs.size() > 1) line["b"] = inputs[1];
    return line;
}

std::string line_of(const ComparisonRun& run, Json line) {
    line["warnings"] = warnings_json(run.warnings);
    line["seconds"] = seconds_since(run.start);
    return to_report_line(line);
}

}  // namespace

ExitCode print_level(Console& console, const ComparisonRun& run, const ComparedLevel& level, bool as_json,
                     bool is_first) {
    const AngularError& e = level.error;
    if (as_json) {
        const auto degrees = [](double angle) { return static_cast<float>(angle); };
        Json line = json_of(run.inputs);
        if (!run.material.empty()) line["material"] = run.material;
        line["level"] = level.number;
        line["extent"] = {level.extent.width, level.extent.height};
        line["texels"] = e.texels;
        line["degrees"] = {{"mean", degrees(e.mean)}, {"rms", degrees(e.rms)},    {"p50", degrees(e.p50)},
                           {"p99", degrees(e.p99)},   {"p99.9", degrees(e.p999)}, {"max", degrees(e.max)}};
        line["max_at"] = {e.max_column, e.max_row};
        return console.print(line_of(run, std::move(line)));
    }
    std::string text;
    if (is_first) {
        if (!run.material.empty()) text = printable(run.material) + ":\n";
        text += fmt::format("{:>5} {:>11} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9}  in degrees; largest at\n", "level",
                            "texels", "mean", "rms", "p50", "p99", "p99.9", "max");
    }
    text += fmt::format("{:>5} {:>11} {:>9.4f} {:>9.4f} {:>9.4f} {:>9.4f} {:>9.4f} {:>9.4f}  column {}, row {}",
                        level.number, fmt::format("{}x{}", level.extent.width, level.extent.height), e.mean, e.rms,
                        e.p50, e.p99, e.p999, e.max, e.max_column, e.max_row);
    if (e.texels != level.extent.texels()) text += fmt::format("; {} texels are covered", e.texels);
    text += '\n';
    return console.print(text);
}

ExitCode print_failure(Console& console, const ComparisonRun& run, const Error& error) {
    Json line = json_of(run.inputs);
    if (!run.material.empty()) line["material"] = run.material;
    line["error"] = error_json(error, "");
    return console.print(line_of(run, std::move(line)));
}

void CompareDocuments::add(Command& command) {
    command.group("Heat map");
    command
        .output_file(heat_map_path_, "--heatmap",
                     "write a picture of the angles with a legend (of the first level compared)")
        .often(3, "write a picture of the angles");
    command
        .option("--heatmap-scale", "DEGREES", "the angle at the end of the legend",
                [this](const std::string& text) {
                    heat_map_scale_ = parse_double(text, {0.0, 180.0, false});
                })
        .preset = "the largest angle";
    command.group("Report");
    command
        .output_file(page_path_, "--report",
                     "write a page with the figures and pictures of both maps, on which the light can be moved")
        .often(3, "write a page with both maps under a light");
    command.output_file(depfile_, "--depfile",
                        "write what the heat map and the page were made from, for Make and Ninja");
}

void CompareDocuments::check(const std::vector<std::string>& inputs) const {
    if (heat_map_scale_ && heat_map_path_.empty()) throw UsageError("--heatmap-scale needs --heatmap");
    const NamedFile heat_map_file = {"--heatmap", heat_map_path_}, page = {"--report", page_path_};
    if (!heat_map_path_.empty()) {
        check_document(heat_map_file, inputs, {});
        const auto container = container_of(heat_map_path_);
        if (!container || !can_hold(*container, Encoding::rgb8))
            throw UsageError("--heatmap", fmt::format("{}: unsupported picture format", printable(heat_map_path_)));
    }
    if (!depfile_.empty()) {
        if (heat_map_path_.empty() && page_path_.empty()) throw UsageError("--depfile needs --heatmap or --report");
        check_document({"--depfile", depfile_}, inputs, {heat_map_file, page});
    }
    if (page_path_.empty()) return;
    check_document(page, inputs, {heat_map_file});
    check_read_twice("--report", inputs);
}

Result<void> CompareDocuments::write_heat_map(const Comparison& comparison) const {
    if (heat_map_path_.empty()) return {};
    const double scale = heat_map_scale_.value_or(std::clamp(comparison.error.max, 0.01, 180.0));
    const auto image = heat_map(comparison.degrees, scale);
    if (!image) return image.error();
    const auto picture = picture_of(*image);
    if (!picture) return picture.error();
    return write_texture(heat_map_path_, *picture);
}

std::string FolderTally::text() const {
    std::string text = fmt::format("maps compared: {}, of which {} differ", maps_, different_);
    if (failed_ > 0) text += fmt::format("; files that failed: {}", failed_);
    if (alone_ > 0) text += fmt::format("; files without a partner: {}", alone_);
    if (different_ > 0) {
        const std::string most = most_ < 0.00005 ? "less than 0.0001" : fmt::format("{:.4f}", most_);
        text += fmt::format("; largest mean: {} degrees, of {}", most, printable(most_of_));
    }
    return text;
}

Result<void> CompareDocuments::add_pair(const std::vector<ComparedLevel>& levels, HtmlMap a, HtmlMap b,
                                        const Plane<float>& degrees) {
    const std::string key = a.file;
    auto entry = compare_entry(levels, std::move(a), std::move(b), degrees, heat_map_scale_);
    if (!entry) return entry.error();
    page_.add(key, std::move(*entry));
    const AngularError& e = levels.front().error;
    figures_ = fmt::format("level {}: mean {:.4f}, 99.9th percentile {:.4f}, largest {:.4f} degrees",
                           levels.front().number, e.mean, e.p999, e.max);
    return {};
}

void CompareDocuments::add_failure(const std::string& name, const Error& error) {
    if (has_page()) page_.add(name, failed_entry(name, error, compare_columns().size()));
}

Result<void> CompareDocuments::write_page(const std::string& summary) const {
    if (!has_page()) return {};
    return write_document(page_path_, page_.page(summary.empty() ? figures_ : summary));
}

Result<void> CompareDocuments::write_depfile(const std::vector<std::string>& inputs) const {
    if (depfile_.empty()) return {};
    std::vector<std::string> outputs = {heat_map_path_, page_path_};
    std::erase(outputs, std::string());
    const auto text = depfile_text({{outputs, inputs}});
    return text ? write_document(depfile_, *text) : text.error();
}

}  // namespace tex::cli
