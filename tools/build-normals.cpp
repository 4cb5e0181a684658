// SPDX-License-Identifier: Apache-2.0
// build-normals: brings a tree of textures up to date, as a manifest says.

#include <algorithm>
#include <filesystem>
#include <memory>

#include <fmt/format.h>

#include "batch/text_file.h"
#include "build/builder.h"
#include "build/explain.h"
#include "build/manifest.h"
#include "build/recipe.h"
#include "build/watch.h"
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
    [[nodiscard]] std::string manifest() const {
        return command.inputs().empty() ? "normals.toml" : command.inputs().front();
    }
    [[nodiscard]] Result<std::unique_ptr<cli::BuildTree>> load(cli::Console& console,
                                                               const cli::FolderVisitor& entered);

    std::string root_;
    std::string explain_;
    bool watch_ = false;
    cli::BuildOptions build_;
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
    command.flag(watch_, "--watch", "stay, and build what is saved, until interrupted");
    command.flag(build_.prune, "--prune", "remove outputs that no rule makes any more");
    command.text(build_.cache, "--cache", "DIR", "take outputs from this folder if they are there, and put them there")
        .completes = cli::Completes::directories;
    command.option("--cache-size", "BYTES", "keep the cache below this size (K, M, G)",
                   [this](const std::string& text) { build_.cache_size = cli::parse_count(text); });
    command
        .option("--memory", "BYTES", "start a file only while all together need no more (K, M, G)",
                [this](const std::string& text) { build_.memory = cli::parse_count(text); })
        .preset = "half of the machine's";
    command.text(build_.depfile, "--depfile", "FILE", "write what each output was made from, for Make and Ninja")
        .completes = cli::Completes::files;
    command.flag(build_.no_sync, "--no-sync", "do not wait until outputs are on the disk");
    running_.add(command);
    command.example("build-normals", "Reads normals.toml and brings every output up to date.");
    command.example("build-normals --dry-run", "What would be made, and why.");
    command.example("build-normals --watch --no-sync", "Builds what is saved, while people work.");
    command.example("build-normals art/normals.toml --explain art/wall_h.png", "Everything about one file.");
    command.check([this] {
        if (command.inputs().size() > 1) throw cli::UsageError("give one manifest");
        if (watch_ && (build_.dry_run || !explain_.empty()))
            throw cli::UsageError("--watch goes neither with --dry-run nor with --explain");
        if (watch_ && !command.inputs().empty() && command.inputs().front() == "-")
            throw cli::UsageError("--watch needs a manifest in a file, not on standard input");
        if (build_.depfile == "-") throw cli::UsageError("--depfile: needs a file, not standard output");
        if (build_.cache_size > 0 && build_.cache.empty()) throw cli::UsageError("--cache-size needs --cache");
    });
}

// Reads the manifest and finds the files.
Result<std::unique_ptr<cli::BuildTree>> BuildNormals::load(cli::Console& console, const cli::FolderVisitor& entered) {
    namespace fs = std::filesystem;
    const std::string path = manifest();
    const auto text = cli::read_text_file(path);
    if (!text) return text.error();
    auto tree = std::make_unique<cli::BuildTree>();
    tree->manifest = cli::parse_manifest(path, *text, cli::step_names());
    const cli::Manifest& manifest = tree->manifest;
    const fs::path file = path == "-" ? fs::path("normals.toml") : fs::path(path);
    build_.root = command.given("--root") ? root_ : file.parent_path().string();
    while (build_.root.size() > 1 && build_.root.ends_with('/')) build_.root.pop_back();
    if (build_.root == ".") build_.root.clear();
    build_.manifest = path;
    build_.state_file = (file.parent_path() / ("." + file.filename().string() + ".state")).string();
    build_.output_version = manifest.output_version.value_or(cli::kOutputVersion);
    if (build_.output_version > cli::kOutputVersion) {
        throw cli::UsageError(fmt::format("{}: output-version = {}, but this program makes version {}", path,
                                          build_.output_version, cli::kOutputVersion));
    }
    tree->recipes.reserve(manifest.rules.size());
    for (const cli::RuleSettings& rule : manifest.rules)
        tree->recipes.emplace_back(manifest, rule, static_cast<int>(tree->recipes.size()) + 1, build_.root, console);
    tree->work = cli::list_work(manifest, tree->recipes, build_.root, entered);
    if (!explain_.empty()) return tree;
    for (std::size_t k = 0; k < tree->recipes.size(); ++k) {
        const auto makes = [k](const cli::BuildTask& task) { return task.recipe == k; };
        if (std::any_of(tree->work.tasks.begin(), tree->work.tasks.end(), makes)) continue;
        console.warning(
            fmt::format("{}: line {}: no file is left for this rule", path, tree->recipes[k].rule().place.line));
    }
    return tree;
}

cli::ExitCode BuildNormals::work(cli::Console& console) {
    if (running_.quiet) console.be_quiet();
    if (watch_) {
        const auto load_tree = [&](const cli::FolderVisitor& entered) { return load(console, entered); };
        return cli::watch(manifest(), load_tree, build_, running_, console);
    }
    const auto tree = load(console, {});
    if (!tree) {
        console.error(tree.error().message());
        return cli::exit_code(tree.error().code);
    }
    const auto& [text, recipes, work] = **tree;
    if (!explain_.empty()) return console.print(cli::explanation_of(explain_, recipes, work));
    return cli::build(recipes, work, build_, running_, console);
}

const cli::Registered<BuildNormals> kRegistered(
    "build-normals", "Brings a tree of textures up to date, as a manifest says: makes what has changed, and no more.");

}  // namespace
