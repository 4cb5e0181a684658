// SPDX-License-Identifier: Apache-2.0
// build-normals: brings a tree of textures up to date, as a manifest says.

#include <algorithm>
#include <filesystem>
#include <memory>

#include <fmt/format.h>

#include "cli/text.h"
#include "cli/usage_error.h"
#include "options/run.h"
#include "options/toml_bounds.h"
#include "tree/builder.h"
#include "tree/explain.h"
#include "tree/farm.h"
#include "tree/init.h"
#include "tree/manifest.h"
#include "tree/recipe.h"
#include "tree/watch.h"
#include "tree/work.h"

namespace {

using namespace tex;

class BuildNormals : public cli::Program {
public:
    explicit BuildNormals(const cli::ProgramRow& row);
    [[nodiscard]] cli::ExitCode work(cli::Console& console) override;

private:
    [[nodiscard]] std::string manifest() const;
    [[nodiscard]] Result<std::unique_ptr<cli::BuildTree>> read(cli::Console& console);
    void find(cli::BuildTree& tree, const cli::FolderVisitor& entered, cli::Console& console) const;
    [[nodiscard]] cli::ExitCode watch(cli::Console& console);

    std::string root_;
    std::string explain_;
    bool watch_ = false;
    bool init_ = false;
    cli::BuildOptions build_;
    cli::Farm farm_;
    cli::RunOptions running_;
};

BuildNormals::BuildNormals(const cli::ProgramRow& row) : Program(row) {
    command.usage("[MANIFEST]");
    command.usage("[MANIFEST] --explain FILE");
    command.usage("[MANIFEST] --init");
    command.input("MANIFEST", "what to build (default: normals.toml)");
    command.finds_things();
    command.group("Build");
    cli::Option& root = command.text(root_, "--root", "DIR", "the folder that paths of the manifest are relative to");
    root.often(2, "the folder that paths of the manifest are relative to").completes = cli::Completes::directories;
    root.preset = "the manifest's";
    command.flag(build_.dry_run, "--dry-run", "print what would be made, and why; write nothing")
        .often(1, "print what would be made, and why; write nothing");
    command.text(explain_, "--explain", "FILE", "print the rule, the settings and the command lines for one file")
        .often(1, "print the rule, the settings and the command lines")
        .completes = cli::Completes::files;
    command.flag(init_, "--init", "write a manifest for the pictures that are here, and a baseline for check-normals")
        .often(1, "write a manifest for the pictures that are here");
    command.flag(watch_, "--watch", "stay, and build what is saved, until interrupted")
        .often(1, "stay, and build what is saved, until interrupted");
    command.flag(build_.prune, "--prune", "remove outputs that no rule makes any more")
        .often(1, "remove outputs that no rule makes any more");
    command.text(build_.cache, "--cache", "DIR", "take outputs from this folder if they are there, and put them there")
        .often(1, "take outputs from this folder, and put them there")
        .completes = cli::Completes::directories;
    command.option("--cache-size", "BYTES", "keep the cache below this size (K, M, G)",
                   [this](const std::string& text) { build_.cache_size = cli::parse_count(text); });
    command
        .option("--memory", "BYTES", "start a file only while all together need no more (K, M, G)",
                [this](const std::string& text) { build_.memory = cli::parse_count(text); })
        .preset = "half of the machine's";
    command.output_file(build_.depfile, "--depfile", "write what each output was made from, for Make and Ninja");
    command.flag(build_.no_sync, "--no-sync", "do not wait until outputs are on the disk");
    farm_.add(command);
    running_.add(command);
    command.example("build-normals", "Reads normals.toml and brings every output up to date.");
    command.example("build-normals --init", "Writes normals.toml for the pictures below this folder.");
    command.example("build-normals --dry-run", "What would be made, and why.");
    command.example("build-normals art/normals.toml --explain art/wall_h.png", "Everything about one file.");
    command.example("build-normals --watch --no-sync", "Builds what is saved, while people work.");
    command.check([this] {
        if (command.inputs().size() > 1 && !farm_.merges()) throw cli::UsageError("give one manifest");
        if (init_ &&
            (build_.dry_run || build_.prune || watch_ || !explain_.empty() || farm_.is_used() || farm_.merges()))
            throw cli::UsageError("--init only writes a manifest: it goes without --dry-run, --prune, --watch ...");
        if (watch_ && (build_.dry_run || !explain_.empty()))
            throw cli::UsageError("--watch goes neither with --dry-run nor with --explain");
        if (watch_ && farm_.is_used()) throw cli::UsageError("--watch and --plan exclude each other");
        if (watch_ && !command.inputs().empty() && command.inputs().front() == "-")
            throw cli::UsageError("--watch needs a manifest in a file, not on standard input");
        if (build_.depfile == "-") throw cli::UsageError("--depfile: needs a file, not standard output");
        if (build_.cache_size > 0 && build_.cache.empty()) throw cli::UsageError("--cache-size needs --cache");
    });
}

cli::ExitCode failed(const Error& error, cli::Console& console) {
    console.error(error.message());
    return cli::exit_code(error.code);
}

std::string BuildNormals::manifest() const {
    if (!command.inputs().empty() && !farm_.merges()) return command.inputs().front();
    return farm_.plan() ? farm_.plan()->manifest : "normals.toml";
}

// Reads the manifest, without looking for files.
Result<std::unique_ptr<cli::BuildTree>> BuildNormals::read(cli::Console& console) {
    namespace fs = std::filesystem;
    const std::string path = manifest();
    auto text = cli::read_toml_file(path);
    if (!text && command.inputs().empty() && !std::filesystem::exists(path))
        return Error{text.error().code, path, text.error().reason + "; build-normals --init writes one"};
    if (!text) return text.error();
    auto tree = std::make_unique<cli::BuildTree>();
    tree->text = std::move(*text);
    tree->manifest = cli::parse_manifest(path, tree->text, cli::step_names());
    const cli::Manifest& manifest = tree->manifest;
    const fs::path file = path == "-" ? fs::path("normals.toml") : fs::path(path);
    if (!command.given("--root") && farm_.plan()) root_ = farm_.plan()->root;
    build_.root = root_.empty() ? file.parent_path().string() : root_;
    while (build_.root.size() > 1 && build_.root.ends_with('/')) build_.root.pop_back();
    if (build_.root == ".") build_.root.clear();
    build_.manifest = path;
    build_.state_file = cli::state_beside(file.string());
    build_.output_version = manifest.output_version.value_or(cli::kOutputVersion);
    if (build_.output_version > cli::kOutputVersion) {
        throw cli::UsageError(fmt::format("{}: output-version = {}, but this program makes version {}", path,
                                          build_.output_version, cli::kOutputVersion));
    }
    farm_.check_fits(path, tree->text, build_, console);
    tree->recipes.reserve(manifest.rules.size());
    for (const cli::RuleSettings& rule : manifest.rules) {
        tree->recipes.emplace_back(manifest, rule, static_cast<int>(tree->recipes.size()) + 1, build_.root, tree->pool,
                                   console);
    }
    return tree;
}

// Finds the files of the tree.
void BuildNormals::find(cli::BuildTree& tree, const cli::FolderVisitor& entered, cli::Console& console) const {
    tree.work = cli::list_work(tree.recipes, build_.root, entered);
    if (!explain_.empty()) return;
    for (std::size_t k = 0; k < tree.recipes.size(); ++k) {
        const auto makes = [k](const cli::BuildTask& task) { return task.recipe == k; };
        if (std::any_of(tree.work.tasks.begin(), tree.work.tasks.end(), makes)) continue;
        console.warning(fmt::format("{}: line {}: this rule applies to no file", tree.manifest.path,
                                    tree.recipes[k].rule().place.line));
    }
    if (const std::vector<std::string>& rest = tree.work.without_rule; !rest.empty()) {
        const std::size_t shown = build_.dry_run ? rest.size() : std::min<std::size_t>(rest.size(), 2);
        std::string names;
        for (std::size_t k = 0; k < shown; ++k) names += (k == 0 ? "" : ", ") + cli::printable(rest[k]);
        console.warning(fmt::format(
            "{}: no rule is for {} picture{} named like normal maps or heights{}{}; list under exclude what no rule is "
            "meant for",
            tree.manifest.path, rest.size(), rest.size() == 1 ? "" : "s",
            shown < rest.size() ? ", such as "
            : rest.size() == 1  ? ", "
                                : ": ",
            names));
    }
}

cli::ExitCode BuildNormals::watch(cli::Console& console) {
    const auto load = [&](const cli::FolderVisitor& entered) {
        auto tree = read(console);
        if (tree) find(**tree, entered, console);
        if (tree) (*tree)->work.other_pictures.clear();  // each build would count them
        return tree;
    };
    return cli::watch(manifest(), load, build_, running_, console);
}

cli::ExitCode BuildNormals::work(cli::Console& console) {
    if (running_.quiet) console.be_quiet();
    if (watch_) return watch(console);
    if (init_) return cli::init_tree(root_, manifest(), running_, console);
    if (const auto plan = farm_.read_plan(); !plan) return failed(plan.error(), console);
    const auto loaded = read(console);
    if (!loaded) return failed(loaded.error(), console);
    cli::BuildTree& tree = **loaded;
    if (farm_.merges()) return farm_.merge(tree.recipes, command.inputs(), build_, running_, console);
    if (farm_.plan()) return farm_.run_shard(tree.recipes, build_, running_, console);
    find(tree, {}, console);
    if (!explain_.empty()) return console.print(cli::explanation_of(explain_, tree.recipes, tree.work, console));
    if (farm_.is_used()) {
        cli::FarmPlan head;
        head.manifest = build_.manifest;
        head.root = root_;
        head.manifest_digest = cli::digest_of(tree.text);
        return farm_.write_plan(head, tree.recipes, tree.work, build_, running_, console);
    }
    return cli::build(tree.recipes, tree.work, build_, running_, console);
}

const cli::Registered<BuildNormals> kRegistered(
    "build-normals", "Brings a tree of textures up to date, as a manifest says: makes what has changed, and no more.");

}  // namespace
