// SPDX-License-Identifier: Apache-2.0
// build-normals: brings a tree of textures up to date, as a manifest says.

#include <algorithm>
#include <filesystem>
#include <optional>

#include <fmt/format.h>

#include "batch/text_file.h"
#include "build/builder.h"
#include "build/explain.h"
#include "build/farm.h"
#include "build/manifest.h"
#include "build/recipe.h"
#include "build/work.h"
#include "cli/usage_error.h"
#include "options/run.h"

namespace {

using namespace tex;

class BuildNormals : public cli::Program {
public:
    explicit BuildNormals(const cli::ProgramRow& row);
    [[nodiscard]] cli::ExitCode work(cli::Console& console) override;

private:
    std::string root_;
    std::string explain_;
    cli::BuildOptions build_;
    cli::Farm farm_;
    cli::RunOptions running_;
};

BuildNormals::BuildNormals(const cli::ProgramRow& row) : Program(row) {
    command.usage("[MANIFEST]");
    command.usage("[MANIFEST] --explain FILE");
    command.input("MANIFEST", "what to build (default: normals.toml)");
    command.finds_things();
    command.group("Build");
    cli::Row& root = command.text(root_, "--root", "DIR", "the folder that paths of the manifest are relative to");
    root.completes = cli::Completes::directories;
    root.preset = "the manifest's";
    command.flag(build_.dry_run, "--dry-run", "print what would be made, and why; write nothing");
    command.text(explain_, "--explain", "FILE", "print the rule, the settings and the command lines for one file")
        .completes = cli::Completes::files;
    command.flag(build_.prune, "--prune", "remove outputs that no rule makes any more");
    command.text(build_.cache, "--cache", "DIR", "take outputs from this folder if they are there, and put them there")
        .completes = cli::Completes::directories;
    command.option("--cache-size", "BYTES", "keep the cache below this size (K, M, G)",
                   [this](const std::string& text) { build_.cache_size = cli::parse_count(text); });
    command
        .option("--memory", "BYTES", "start a file only while all together need no more (K, M, G)",
                [this](const std::string& text) { build_.memory = cli::parse_count(text); })
        .preset = "half of the machine's";
    command.flag(build_.no_sync, "--no-sync", "do not wait until outputs are on the disk");
    farm_.add(command);
    running_.add(command);
    command.example("build-normals", "Reads normals.toml and brings every output up to date.");
    command.example("build-normals --dry-run", "What would be made, and why.");
    command.example("build-normals art/normals.toml --explain art/wall_h.png", "Everything about one file.");
    command.check([this] {
        if (command.inputs().size() > 1 && !farm_.merges()) throw cli::UsageError("give one manifest");
        if (build_.cache_size > 0 && build_.cache.empty()) throw cli::UsageError("--cache-size needs --cache");
    });
}

cli::ExitCode failed(const Error& error, cli::Console& console) {
    console.error(error.message());
    return cli::exit_code(error.code);
}

cli::ExitCode BuildNormals::work(cli::Console& console) {
    namespace fs = std::filesystem;
    if (running_.quiet) console.be_quiet();
    if (const auto read = farm_.read_plan(); !read) return failed(read.error(), console);
    const bool is_named = !command.inputs().empty() && !farm_.merges();
    const std::string path = is_named       ? command.inputs().front()
                             : farm_.plan() ? farm_.plan()->manifest
                                            : "normals.toml";
    const auto text = cli::read_text_file(path);
    if (!text) return failed(text.error(), console);
    const cli::Manifest manifest = cli::parse_manifest(path, *text, cli::step_names());
    const fs::path file = path == "-" ? fs::path("normals.toml") : fs::path(path);
    if (!command.given("--root") && farm_.plan()) root_ = farm_.plan()->root;
    build_.root = root_.empty() ? file.parent_path().string() : root_;
    while (build_.root.size() > 1 && build_.root.ends_with('/')) build_.root.pop_back();
    if (build_.root == ".") build_.root.clear();
    build_.state_file = (file.parent_path() / ("." + file.filename().string() + ".state")).string();
    build_.output_version = manifest.output_version.value_or(cli::kOutputVersion);
    if (build_.output_version > cli::kOutputVersion) {
        throw cli::UsageError(fmt::format("{}: output-version = {}, but this program makes version {}", path,
                                          build_.output_version, cli::kOutputVersion));
    }
    farm_.check_fits(path, *text, build_, console);
    if (farm_.merges()) return farm_.merge(command.inputs(), build_, running_, console);
    std::vector<cli::Recipe> recipes;
    recipes.reserve(manifest.rules.size());
    for (const cli::RuleSettings& rule : manifest.rules)
        recipes.emplace_back(manifest, rule, static_cast<int>(recipes.size()) + 1, build_.root, console);
    if (farm_.plan()) return farm_.run_shard(recipes, build_, running_, console);
    const cli::WorkList work = cli::list_work(manifest, recipes, build_.root);
    if (!explain_.empty()) return console.print(cli::explanation_of(explain_, recipes, work));
    for (std::size_t k = 0; k < recipes.size(); ++k) {
        const auto makes = [k](const cli::BuildTask& task) { return task.recipe == k; };
        if (std::any_of(work.tasks.begin(), work.tasks.end(), makes)) continue;
        console.warning(fmt::format("{}: line {}: no file is left for this rule", path, recipes[k].rule().place.line));
    }
    if (farm_.is_used()) {
        cli::FarmPlan head;
        head.manifest = path;
        head.root = root_;
        head.manifest_digest = cli::digest_of(*text);
        return farm_.write_plan(head, work, build_, running_, console);
    }
    return cli::build(recipes, work, build_, running_, console);
}

const cli::Registered<BuildNormals> kRegistered(
    "build-normals", "Brings a tree of textures up to date, as a manifest says: makes what has changed, and no more.");

}  // namespace
