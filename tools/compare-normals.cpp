// SPDX-License-Identifier: Apache-2.0
// compare-normals: how far two normal maps lie apart.

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>
#include <tex/tex.h>

#include "batch/batch.h"
#include "batch/collisions.h"
#include "cli/console.h"
#include "cli/interrupt.h"
#include "cli/stream.h"
#include "cli/text.h"
#include "cli/usage_error.h"
#include "reports/html_report.h"
#include "reports/json.h"

namespace {

using namespace tex;

struct CompareNormals {
    cli::Command command{"compare-normals",
                         "Compares two normal maps, in any two encodings: the angle between their normals in degrees."};
    std::optional<YAxis> y_a, y_b;
    int level = 0;
    bool all_levels = false;
    std::optional<double> max_mean, max_p999, max;
    std::string heat_map_path, page_path;
    std::optional<double> heat_map_scale;
    cli::RunOptions run;
    std::set<std::string> warned_of;  // files

    CompareNormals();
    void check_documents() const;
    void add_limit(std::optional<double>& limit, const std::string& name, const std::string& what);
    [[nodiscard]] Execution execution(double from, double to, const std::string& words) const;
    [[nodiscard]] Result<Texture> read_map(const std::string& path, std::optional<YAxis> y);
    Result<std::vector<NormalMap>> read(const std::string& path, std::optional<YAxis> y, double from, double to);
    Result<cli::ExitCode> compare_files();
    [[nodiscard]] cli::ExitCode tell(const Error& error) const;
    [[nodiscard]] cli::ExitCode tell(int number, Extent extent, const AngularError& error) const;
    cli::ExitCode judge(int number, const AngularError& error) const;
    Result<void> write_heat_map(const Comparison& comparison) const;
    [[nodiscard]] Result<cli::HtmlMap> draw_map(const std::string& path, std::optional<YAxis> y, double from,
                                                double to);
    [[nodiscard]] Result<void> write_page(const std::vector<cli::ComparedLevel>& levels, const Plane<float>& degrees);
};

CompareNormals::CompareNormals() {
    command.usage("A B");
    command.input("A B", "two textures or pictures; - is standard input");
    command.finds_things();
    command.group("What is compared");
    command.choice(y_a, "--y-a", "Y", kYAxisNames, "which way green points in A, instead of what the file says");
    command.choice(y_b, "--y-b", "Y", kYAxisNames, "which way green points in B");
    command
        .option("--level", "N", "the level, 0 being the base level, or all that both have",
                [this](const std::string& text) {
                    all_levels = text == "all";
                    if (!all_levels) level = cli::parse_int(text, 0, 31);
                })
        .preset = std::to_string(level);
    command.group("Limits");
    add_limit(max_mean, "--max-mean", "mean");
    add_limit(max_p999, "--max-p999", "99.9th percentile");
    add_limit(max, "--max", "largest angle");
    command.group("Heat map");
    command
        .text(heat_map_path, "--heatmap", "FILE",
              "write a picture of the angles with a legend (of the first level compared)")
        .completes = cli::Completes::files;
    command
        .option("--heatmap-scale", "DEGREES", "the angle at the end of the legend",
                [this](const std::string& text) {
                    heat_map_scale = cli::parse_double(text, {0.0, 180.0, false});
                })
        .preset = "the largest angle";
    command.group("Report");
    command
        .text(page_path, "--report", "FILE",
              "write a page with the figures and pictures of both maps, on which the light can be moved")
        .completes = cli::Completes::files;
    run.add(command);
    command.check([this] {
        if (command.inputs().size() != 2) throw cli::UsageError("two files are compared: A and B");
        if (heat_map_scale && heat_map_path.empty()) throw cli::UsageError("--heatmap-scale needs --heatmap");
        if (command.inputs()[0] == "-" && command.inputs()[1] == "-")
            throw cli::UsageError("standard input can only be read once");
        check_documents();
    });
    command.example("compare-normals bricks.exr bricks.dds", "What the compression of bricks.dds cost.");
    command.example("compare-normals old.dds new.dds --level all --max-p999 2 --heatmap diff.png",
                    "Fails where more than 1 texel in 1000 moved by over 2 degrees, and shows where.");
    command.example("compare-normals bricks.exr bricks.dds --report loss.html",
                    "A page with both maps under a light that can be moved.");
    command.example("compare-normals gl.png dx.png --y-b down", "Two conventions of one map.");
}

void CompareNormals::check_documents() const {
    const cli::NamedFile heat_map_file = {"--heatmap", heat_map_path}, page = {"--report", page_path};
    if (!heat_map_path.empty()) {
        cli::check_document(heat_map_file, command.inputs(), {});
        const auto container = container_of(heat_map_path);
        if (!container || !can_hold(*container, Encoding::rgb8))
            throw cli::UsageError(
                fmt::format("--heatmap: {} is no kind of picture that can be written", cli::printable(heat_map_path)));
    }
    if (page_path.empty()) return;
    cli::check_document(page, command.inputs(), {heat_map_file});
    cli::check_read_twice("--report", command.inputs());
}

void CompareNormals::add_limit(std::optional<double>& limit, const std::string& name, const std::string& what) {
    command.option(name, "DEGREES", fmt::format("fail (exit 1) where the {} is greater", what),
                   [&limit](const std::string& text) {
                       limit = cli::parse_double(text, {0.0, 180.0});
                   });
}

// What runs so is the run's progress from `from` to `to`; `words` stand beside the bar.
Execution CompareNormals::execution(double from, double to, const std::string& words) const {
    const bool shown = run.shows_progress();
    if (shown) cli::draw_progress(from, words);
    return {run.threads, [=](double done) {
                if (shown) cli::draw_progress(from + (to - from) * done, words);
                return cli::caught_signal() == 0;
            }};
}

// The texture, with the swizzle that its texels show where it does not say its own, and with what the options say of y.
Result<Texture> CompareNormals::read_map(const std::string& path, std::optional<YAxis> y) {
    auto texture = read_texture(path, run.read);
    if (!texture) return texture.error();
    const auto swizzle = guess_swizzle(*texture, {run.threads, [](double) { return cli::caught_signal() == 0; }});
    if (!swizzle) return Error{swizzle.error().code, path, swizzle.error().reason};
    if (*swizzle != texture->swizzle && warned_of.insert(path).second) {
        cli::print_warning(fmt::format("{}: taken for {}, as the texels look", path, name_of(kSwizzleNames, *swizzle)));
    }
    texture->swizzle = *swizzle;
    texture->y_axis = y.value_or(texture->y_axis);
    return texture;
}

Result<std::vector<NormalMap>> CompareNormals::read(const std::string& path, std::optional<YAxis> y, double from,
                                                    double to) {
    const Execution shown = execution(from, to, path);
    const auto texture = read_map(path, y);
    if (!texture) return texture.error();
    auto chain = unpack(*texture, {}, shown);
    if (chain) return std::move(chain->levels);
    return Error{chain.error().code, path, chain.error().reason};
}

cli::ExitCode CompareNormals::tell(int number, Extent extent, const AngularError& e) const {
    cli::clear_progress();
    if (run.json) {
        const auto degrees = [](double angle) { return static_cast<float>(angle); };
        cli::Json line;
        line["a"] = command.inputs()[0];
        line["b"] = command.inputs()[1];
        line["level"] = number;
        line["extent"] = {extent.width, extent.height};
        line["texels"] = e.texels;
        line["degrees"] = {{"mean", degrees(e.mean)}, {"rms", degrees(e.rms)},    {"p50", degrees(e.p50)},
                           {"p99", degrees(e.p99)},   {"p99.9", degrees(e.p999)}, {"max", degrees(e.max)}};
        line["max_at"] = {e.max_column, e.max_row};
        return cli::print(cli::to_line(line));
    }
    return cli::print(
        fmt::format("{:>5} {:>11} {:>9.4f} {:>9.4f} {:>9.4f} {:>9.4f} {:>9.4f} {:>9.4f}  column {}, row {}\n", number,
                    fmt::format("{}x{}", extent.width, extent.height), e.mean, e.rms, e.p50, e.p99, e.p999, e.max,
                    e.max_column, e.max_row));
}

cli::ExitCode CompareNormals::tell(const Error& error) const {
    cli::print_error(error.message());
    if (!run.json) return cli::ExitCode::done;
    cli::Json line;
    line["a"] = command.inputs()[0];
    line["b"] = command.inputs()[1];
    line["error"] = cli::error_json(error, "");
    return cli::print(cli::to_line(line));
}

cli::ExitCode CompareNormals::judge(int number, const AngularError& error) const {
    cli::ExitCode code = cli::ExitCode::done;
    const auto hold = [&](const char* name, double figure, std::optional<double> limit) {
        if (!limit || figure <= *limit) return;
        cli::print_error(
            fmt::format("level {}: {} {:.4f} degrees is over the limit of {}", number, name, figure, *limit));
        code = cli::ExitCode::findings;
    };
    hold("mean", error.mean, max_mean);
    hold("p99.9", error.p999, max_p999);
    hold("max", error.max, max);
    return code;
}

Result<void> CompareNormals::write_heat_map(const Comparison& comparison) const {
    const double scale = heat_map_scale.value_or(std::clamp(comparison.error.max, 0.01, 180.0));
    const auto image = heat_map(comparison.degrees, scale);
    if (!image) return image.error();
    const auto picture = picture_of(*image);
    if (!picture) return picture.error();
    return write_texture(heat_map_path, *picture);
}

Result<cli::HtmlMap> CompareNormals::draw_map(const std::string& path, std::optional<YAxis> y, double from, double to) {
    const Execution shown = execution(from, to, path);
    const auto texture = read_map(path, y);
    if (!texture) return texture.error();
    return cli::draw_html_map(path, *texture, texture->swizzle, cli::html_sizes(1), shown);
}

Result<void> CompareNormals::write_page(const std::vector<cli::ComparedLevel>& levels, const Plane<float>& degrees) {
    auto a = draw_map(command.inputs()[0], y_a, 0.8, 0.9);
    if (!a) return a.error();
    auto b = draw_map(command.inputs()[1], y_b, 0.9, 1.0);
    if (!b) return b.error();
    auto entry = cli::compare_entry(levels, std::move(*a), std::move(*b), degrees, heat_map_scale);
    if (!entry) return entry.error();
    cli::HtmlReport page("compare-normals", cli::compare_columns());
    page.add("", std::move(*entry));
    const AngularError& e = levels.front().error;
    const std::string text =
        page.page(fmt::format("level {}: mean {:.4f}, 99.9th percentile {:.4f}, largest {:.4f} degrees",
                              levels.front().number, e.mean, e.p999, e.max));
    const auto* bytes = reinterpret_cast<const std::byte*>(text.data());
    return write_file(page_path, std::vector<std::byte>(bytes, bytes + text.size()));
}

Result<cli::ExitCode> CompareNormals::compare_files() {
    const std::string &name_a = command.inputs()[0], &name_b = command.inputs()[1];
    const auto a = read(name_a, y_a, 0.0, 0.3);
    if (!a) return a.error();
    const auto b = read(name_b, y_b, 0.3, 0.6);
    if (!b) return b.error();
    const std::size_t first = all_levels ? 0 : static_cast<std::size_t>(level);
    const std::size_t end = all_levels ? std::min(a->size(), b->size()) : first + 1;
    if (all_levels && a->size() != b->size()) {
        cli::print_warning(fmt::format("levels: {} of {}, {} of {}; only those that both have are compared", a->size(),
                                       name_a, b->size(), name_b));
    }
    cli::ExitCode code = cli::ExitCode::done, told = code;
    std::vector<cli::ComparedLevel> levels;  // of the page
    Plane<float> degrees;
    const double until = page_path.empty() ? 1.0 : 0.8;  // of the progress: smaller levels take no time to speak of
    for (std::size_t k = first; k < end; ++k) {
        const auto lacks = [&](const std::string& name, std::size_t count) {
            return Error{ErrorCode::bad_option, name, fmt::format("has {} levels, so none of number {}", count, k)};
        };
        if (k >= a->size()) return lacks(name_a, a->size());
        if (k >= b->size()) return lacks(name_b, b->size());
        const NormalMap &map_a = (*a)[k], &map_b = (*b)[k];
        if (map_a.extent() != map_b.extent()) {
            return Error{ErrorCode::bad_option, name_b,
                         fmt::format("is {}x{} texels, {} is {}x{}", map_b.extent().width, map_b.extent().height,
                                     name_a, map_a.extent().width, map_a.extent().height)};
        }
        auto comparison = compare(map_a, map_b, execution(k == first ? 0.6 : until, until, fmt::format("level {}", k)));
        if (!comparison) return comparison.error();
        if (k == first && !run.json) {
            cli::clear_progress();
            told = cli::print(fmt::format("{:>5} {:>11} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9}  in degrees; largest at\n",
                                          "level", "texels", "mean", "rms", "p50", "p99", "p99.9", "max"));
        }
        if (told == cli::ExitCode::done) told = tell(static_cast<int>(k), map_a.extent(), comparison->error);
        const cli::ExitCode judged = judge(static_cast<int>(k), comparison->error);
        code = std::max({code, judged, told});
        levels.push_back({static_cast<int>(k), map_a.extent(), comparison->error, judged == cli::ExitCode::done});
        if (k > first) continue;
        if (!heat_map_path.empty()) {
            if (auto written = write_heat_map(*comparison); !written) return written.error();
        }
        degrees = std::move(comparison->degrees);
    }
    if (!page_path.empty()) {
        if (auto written = write_page(levels, degrees); !written) return written.error();
    }
    return code;
}

}  // namespace

int main(int argc, char** argv) {
    return cli::run_main("compare-normals", [&] {
        CompareNormals self;
        if (const auto ended = self.command.parse(argc, argv)) return *ended;
        cli::catch_signals();
        const auto code = self.compare_files();
        cli::clear_progress();
        if (const int signal = cli::caught_signal(); signal != 0) cli::end_by_signal(signal);
        if (code) return *code;
        return std::max(self.tell(code.error()), cli::exit_code(code.error().code));
    });
}
