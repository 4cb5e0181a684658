// SPDX-License-Identifier: Apache-2.0

#include "tree/init.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <filesystem>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <tbb/info.h>
#include <tex/check.h>
#include <tex/file.h>
#include <tex/format.h>

#include "cli/file_status.h"
#include "cli/glob.h"
#include "cli/json.h"
#include "cli/text.h"
#include "cli/text_file.h"
#include "reports/baseline.h"
#include "reports/kinds.h"
#include "tasks/find_files.h"
#include "tasks/model_output.h"
#include "threads/fork_join.h"
#include "tree/height_traits.h"
#include "tree/infer_rules.h"

namespace tex::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kBaselineName = "normals-baseline.json";

// A path below the root as a TOML string.
std::string quoted(const std::string& text) { return Json(text).dump(); }

std::string list_of(const std::vector<std::string>& patterns) {
    if (patterns.size() == 1) return quoted(patterns.front());
    std::string text = "[";
    for (const std::string& pattern : patterns) text += fmt::format("\n  {},", quoted(pattern));
    return text + "\n]";
}

bool has_error(const CheckReport& report) {
    return report.error || std::any_of(report.findings.begin(), report.findings.end(),
                                       [](const Finding& finding) { return finding.severity == Severity::error; });
}

bool has_rule(const CheckReport& report, std::string_view id) {
    return std::any_of(report.findings.begin(), report.findings.end(),
                       [id](const Finding& finding) { return finding.rule->id == id; });
}

// What the texels show, or else make likely: in maps that are too small to be sure.
std::optional<YAxis> likely_y(const CheckReport& report) {
    constexpr double kClear = 0.5;
    if (report.y.y || std::abs(report.y.correlation) < kClear) return report.y.y;
    return report.y.correlation > 0.0 ? YAxis::up : YAxis::down;
}

// What a rule's only step says about normals, as TOML.
std::string pack_step(std::optional<YAxis> y, const CheckReport& report, const std::string& layout) {
    std::vector<std::string> settings;
    if (y) settings.push_back(fmt::format("y-in = \"{}\"", name_of(kYAxisNames, *y)));
    if (!layout.empty()) settings.push_back(fmt::format("swizzle = \"{}\"", layout));
    if (report.more_data) settings.emplace_back("drop = true");
    if (settings.empty()) return "{ pack = {} }";
    std::string text;
    for (const std::string& setting : settings) text += (text.empty() ? "" : ", ") + setting;
    return fmt::format("{{ pack = {{ {} }} }}", text);
}

constexpr std::string_view kBakeStep = "{ bake = {";

std::string bake_step(const CheckReport& report, const HeightTraits& traits) {
    std::string settings = traits.is_on_ground ? "" : " bumpiness = \"auto\"";
    if (traits.has_wall) settings += ", wrap = \"clamp\"";
    if (report.height_bytes) {
        settings += fmt::format("{} channel = \"{}\"", settings.empty() ? "" : ",",
                                name_of(kHeightChannelNames, *report.height_bytes));
    }
    return fmt::format("{}{}{}}} }}", kBakeStep, settings, settings.empty() ? "" : " ");
}

// The pictures of a tree, what they hold, and why no rule is for some of them.
class Tree {
public:
    Tree(std::vector<FoundFile> files, std::string root) : files_(std::move(files)), root_(std::move(root)) {
        reports_.resize(files_.size());
        why_not_.resize(files_.size());
        traits_.resize(files_.size());
    }

    [[nodiscard]] std::string path_of(std::size_t k) const {
        return root_.empty() ? files_[k].path : root_ + "/" + files_[k].path;
    }

    void check(const RunOptions& running, Console& console) {
        std::atomic<std::size_t> next{0}, done{0};
        const bool shows = running.shows_progress(console.host());
        const auto work = [&](int) {
            for (std::size_t k = next++; k < files_.size() && console.host().interruption().empty(); k = next++) {
                auto report = check_file(path_of(k), {}, running.read, {1, {}});
                if (report) reports_[k] = std::move(*report);
                if (holds_heights(k)) traits_[k] = traits_of(path_of(k), reports_[k], running.read);
                const std::size_t count = ++done;
                if (shows)
                    console.draw_progress(static_cast<double>(count) / static_cast<double>(files_.size()),
                                          fmt::format("{} of {} files", count, files_.size()));
            }
        };
        const int threads = running.threads > 0 ? running.threads : tbb::info::default_concurrency();
        const int workers = std::min(threads, static_cast<int>(std::min<std::size_t>(files_.size(), 64)));
        if (workers <= 1)
            work(0);
        else
            fork_join(workers, workers, work);
        console.clear_progress();
    }

    // The settings of every file, for infer_rules().
    [[nodiscard]] std::vector<SettingsOfFile> settings() {
        std::set<std::string> materials;  // that have a normal map
        for (std::size_t k = 0; k < files_.size(); ++k) {
            if (holds_normals(k)) materials.insert(name_beginning(files_[k].path));
        }
        std::vector<SettingsOfFile> all;
        std::set<std::string> outputs;  // names without extension, which outputs get
        for (std::size_t k = 0; k < files_.size(); ++k) {
            SettingsOfFile file{files_[k].path, {}, {}, false};
            settle(k, materials, file);
            if (printable(file.path) != file.path) {  // bytes that no TOML may hold, or that nobody could read
                file = {file.path, {}, {}, false};
                why_not_[k] = "the name is not UTF-8, or holds control characters";
            }
            const std::string stem = file.path.substr(0, file.path.rfind('.'));
            if ((!file.settings.empty() || !file.also.empty()) && !outputs.insert(stem).second) {
                file.settings.clear();
                file.also.clear();
                file.is_left_out = true;
                why_not_[k] = "another picture of this name has the same output";
            }
            all.push_back(std::move(file));
        }
        return all;
    }

    // All pictures count: whoever checks a whole folder checks its colours and heights, too.
    [[nodiscard]] Baseline baseline(const std::string& path) const {
        Baseline baseline(path);
        for (std::size_t k = 0; k < files_.size(); ++k) {
            baseline.add(reports_[k], content_of(path_of(k)));
        }
        return baseline;
    }

    [[nodiscard]] int count_findings() const {
        int count = 0;
        for (std::size_t k = 0; k < files_.size(); ++k) count += static_cast<int>(reports_[k].findings.size());
        return count;
    }

    [[nodiscard]] std::string comments() const {
        std::map<std::string, std::vector<std::string>> by_reason;
        for (std::size_t k = 0; k < files_.size(); ++k) {
            if (!why_not_[k].empty()) by_reason[why_not_[k]].push_back(files_[k].path);
        }
        std::string text;
        for (const auto& [reason, paths] : by_reason) {
            text += fmt::format("\n# No rule: {}.\n", reason);
            for (const std::string& path : paths) text += fmt::format("#     {}\n", printable(path));
        }
        return text;
    }

    // Why no rule is for the files, of which the first few are named.
    [[nodiscard]] std::string reasons() const {
        constexpr std::size_t kMost = 5;
        std::vector<std::string> words;
        for (std::size_t k = 0; k < files_.size() && words.size() < kMost; ++k)
            if (!why_not_[k].empty()) words.push_back(fmt::format("{} ({})", printable(path_of(k)), why_not_[k]));
        return join(words) + (files_.size() > kMost ? " ..." : "");
    }

    // What a rule says of files that their texels do not show.
    [[nodiscard]] std::string caveats(const InferredRule& rule) const {
        std::string text;
        std::vector<std::string> unknown;
        const std::set<std::string> of_rule(rule.files.begin(), rule.files.end());
        for (std::size_t k = 0; k < files_.size(); ++k) {
            if (of_rule.contains(files_[k].path) && holds_normals(k) && !reports_[k].y.y)
                unknown.push_back(files_[k].path);
        }
        if (!unknown.empty() && unknown.size() == rule.files.size()) {
            text += "# A guess: the texels do not show for sure where green points.\n";
        } else if (!unknown.empty()) {
            text += "# A guess for these, whose texels do not show for sure where green points:\n";
            for (const std::string& path : unknown) text += fmt::format("#     {}\n", printable(path));
        }
        if (rule.settings.find("drop = true") != std::string::npos)
            text += "# What their other channels hold, such as heights or gloss in alpha, is left out (drop).\n";
        return text;
    }

    [[nodiscard]] KindTotals totals() const {
        KindTotals totals;
        for (const CheckReport& report : reports_) totals.add(report);
        return totals;
    }

    [[nodiscard]] bool holds_normals(std::size_t k) const {
        const PictureKind kind = reports_[k].kind;
        return kind == PictureKind::normals || kind == PictureKind::object_space;
    }

private:
    [[nodiscard]] bool holds_heights(std::size_t k) const {
        const PictureKind kind = reports_[k].kind;
        return kind == PictureKind::heights ||
               (kind == PictureKind::grey && named_as(files_[k].path) == NamedAs::heights);
    }

    void settle(std::size_t k, const std::set<std::string>& materials, SettingsOfFile& file) {
        const CheckReport& report = reports_[k];
        const bool is_normals = report.kind == PictureKind::normals;
        if (report.kind == PictureKind::unknown) {
            why_not_[k] = "cannot be decoded";
        } else if (is_normals && has_error(report)) {
            why_not_[k] = "normals, in which check-normals finds errors";
        } else if (is_normals && format_info(report.format).has_blocks()) {
            why_not_[k] = "normals that are compressed already";
        } else if (is_normals) {
            // pack-normals reads other data in blue, and the channels of the X-Ray engine, only where it is told.
            const bool is_labpbr = report.swizzle == kSwizzleXy && format_info(report.format).channels > 2;
            const std::string layout = is_labpbr || has_rule(report, "N223") ? swizzle_word(report.swizzle) : "";
            if (const std::optional<YAxis> likely = likely_y(report)) {
                file.settings = pack_step(likely, report, layout);
            } else {
                // LabPBR has green down.
                for (const YAxis y : {is_labpbr ? YAxis::down : YAxis::up, is_labpbr ? YAxis::up : YAxis::down})
                    file.also.push_back(pack_step(y, report, layout));
            }
            return;
        } else if (report.kind == PictureKind::object_space) {
            why_not_[k] = "normals in object space, which convert-normals turns into tangent space with the mesh";
        } else if (holds_heights(k)) {
            if (materials.find(name_beginning(file.path)) == materials.end()) {
                file.settings = bake_step(report, traits_[k]);
                return;
            }
            why_not_[k] = "heights with a normal map beside them";
        } else {
            why_not_[k] = std::string(meaning_of(report.kind));
        }
        file.is_left_out = is_normals || report.kind == PictureKind::unknown;
    }

    static std::string_view meaning_of(PictureKind kind) {
        for (const Named<PictureKind>& row : kPictureKindNames) {
            if (row.value == kind) return row.meaning;
        }
        return {};
    }

    std::vector<FoundFile> files_;
    const std::string root_;
    std::vector<CheckReport> reports_;
    std::vector<std::string> why_not_;
    std::vector<HeightTraits> traits_;
};

std::string manifest_text(const std::vector<InferredRule>& rules, const Tree& tree) {
    std::string text =
        "# Written by build-normals --init, from what the pictures of this tree hold: read it, and change what you "
        "know\n"
        "# better. normals.toml(5) explains it; build-normals --dry-run says what it would make.\n"
        "version = 1\n\n"
        "[defaults]\n"
        "out-dir = \"build/textures\"\n"
        "name = \"{dir}/{stem}\"\n"
        "# For an engine, write its name instead of all that stands in braces, as in { for = \"unity\" }:\n"
        "# normal-maps-engines(7).\n"
        "outputs = [ { format = \"bc5\", y = \"up\", mips = \"all\" } ]\n";
    for (const InferredRule& rule : rules) {
        const bool bakes = rule.settings.starts_with(kBakeStep);
        text += fmt::format("\n# {} of {} file{}{}.\n{}[[rule]]\nmatch = {}\n", bakes ? "Heights" : "Normals",
                            rule.files.size(), rule.files.size() == 1 ? "" : "s",
                            rule.settings.find("auto") == std::string::npos
                                ? ""
                                : "; where you know their height, height-range and world-size are better than auto",
                            tree.caveats(rule), list_of(rule.match));
        if (!rule.exclude.empty()) text += fmt::format("exclude = {}\n", list_of(rule.exclude));
        text += fmt::format("steps = [ {} ]\n", rule.settings);
    }
    return text + tree.comments();
}

Result<void> write_new(const std::string& path, const std::string& text) {
    WriteOptions write;
    write.no_clobber = true;
    return write_document(path, text, write);
}

// What is there, if no picture is.
std::string no_pictures(const std::string& where, std::ptrdiff_t models) {
    if (models == 0) return fmt::format("nothing is written: no picture is below {}", where);
    return fmt::format(
        "nothing is written: no picture is below {}, and no rule is for models ({}): check-normals and "
        "repair-normals take their maps",
        where, models);
}

ExitCode failed(const Error& error, Console& console) {
    console.error(error.message());
    return exit_code(error.code);
}

}  // namespace

ExitCode init_tree(const std::string& root, const std::string& manifest, const RunOptions& running, Console& console) {
    const std::string baseline = (fs::path(manifest).parent_path() / kBaselineName).string();
    for (const std::string& path : {manifest, baseline}) {
        if (fs::symlink_status(path).type() != fs::file_type::not_found)
            return failed({ErrorCode::io, path, "is there already; --init writes new files only"}, console);
    }
    const std::string where = root.empty() ? "this folder" : root;
    const Glob all("**");
    FileSearch search;
    search.globs = {&all};
    search.skip = [](const std::string&) { return false; };
    search.unreadable = [&](const std::string& folder, const std::string& reason) {
        console.warning(folder + ": " + reason);
    };
    std::vector<FoundFile> pictures = find_files(root, search);
    const auto models =
        std::count_if(pictures.begin(), pictures.end(), [](const FoundFile& file) { return names_model(file.path); });
    std::erase_if(pictures, [](const FoundFile& file) { return !is_picture(file.path) && !is_height_file(file.path); });
    if (pictures.empty()) return failed({ErrorCode::bad_data, manifest, no_pictures(where, models)}, console);
    Tree tree(std::move(pictures), root);
    tree.check(running, console);
    if (const std::string_view by = console.host().interruption(); !by.empty()) {
        console.error(fmt::format("interrupted by {}; nothing is written", by));
        console.host().end_interrupted();
        return ExitCode::io;
    }
    const std::vector<InferredRule> rules = infer_rules(tree.settings());
    if (rules.empty()) {
        return failed({ErrorCode::bad_data, manifest,
                       fmt::format("nothing is written: {} below {}, and no rule can be for any of them: {}",
                                   tree.totals().text(), where, tree.reasons())},
                      console);
    }
    if (auto written = write_new(manifest, manifest_text(rules, tree)); !written)
        return failed(written.error(), console);
    if (auto written = write_new(baseline, tree.baseline(baseline).text()); !written)
        return failed(written.error(), console);
    std::size_t files = 0;
    for (const InferredRule& rule : rules) files += rule.files.size();
    std::string text =
        fmt::format("{}\n{}: {} rule{} for {} of them; {}: {} finding{} accepted\n", tree.totals().text(),
                    printable(manifest), rules.size(), rules.size() == 1 ? "" : "s", files, printable(baseline),
                    tree.count_findings(), tree.count_findings() == 1 ? "" : "s");
    const std::string at = (manifest == "normals.toml" ? "" : " " + shell_word(manifest)) +
                           (root.empty() ? "" : " --root " + shell_word(root));
    if (models > 0)
        text += fmt::format("models without a rule: {}; check-normals and repair-normals take their maps\n", models);
    text += fmt::format(
        "next: build-normals{} --dry-run shows what it makes, and build-normals{} makes it\n"
        "      check-normals {} --baseline {} fails for new findings alone\n",
        at, at, shell_word(root.empty() ? "." : root), shell_word(baseline));
    return console.print(text);
}

}  // namespace tex::cli
