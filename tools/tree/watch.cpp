// SPDX-License-Identifier: Apache-2.0

#include "tree/watch.h"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <optional>
#include <set>
#include <system_error>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include <fmt/format.h>

#include "cli/file_status.h"
#include "cli/usage_error.h"
#include "files/path_names.h"
#include "tree/build_run.h"
#include "tree/file_events.h"

namespace tex::cli {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

// What is saved together is built together: so long nothing else may be saved, but the wait ends at last.
constexpr milliseconds kSettles{8};
constexpr milliseconds kSettlesAtLast{40};
// Some editors remove a file, or rename it, and then write it.
constexpr milliseconds kMayComeBack{250};
// How often interruption() is asked, besides when a signal ends a wait. The process ends a second after the signal.
constexpr milliseconds kPatience{200};

class Watch {
public:
    Watch(const std::string& manifest, const LoadTree& load, const BuildOptions& options, const RunOptions& running,
          Console& console)
        : manifest_(absolute(manifest)), cache_(options.cache.empty() ? "" : absolute(options.cache) + "/"),
          load_(load), options_(options), running_(running), console_(console) {}

    ExitCode run();

private:
    [[nodiscard]] static std::string absolute(const std::string& path) {
        return slashed(fs::absolute(path).lexically_normal());
    }
    [[nodiscard]] std::string path(const std::string& name) const;
    void add(const std::string& folder);
    void add_parent_of(const std::string& file);
    void add_link(const std::string& name);
    [[nodiscard]] std::unique_ptr<BuildTree> read_tree();
    void learn_names();
    void load();
    void build(const WorkList& work, bool is_part);
    void build_what_is_due();

    [[nodiscard]] bool is_input(const std::string& name) const;
    [[nodiscard]] bool is_folder_of_inputs(const std::string& name) const;
    void note(FileEventKind kind, const std::string& name);
    [[nodiscard]] bool is_pending() const { return everything_ || !saved_.empty() || !created_.empty(); }
    [[nodiscard]] Clock::time_point due() const;
    void wait_until_due();
    [[nodiscard]] bool ends() const { return failure_ || is_abandoned_ || !console_.host().interruption().empty(); }

    const std::string manifest_;  // absolute
    const std::string cache_;     // absolute, with "/" at its end; empty if there is none
    const LoadTree& load_;
    const BuildOptions& options_;
    const RunOptions& running_;
    Console& console_;
    FileEvents events_;
    std::optional<Error> failure_;  // nothing can be watched
    bool is_abandoned_ = false;     // nobody reads what is printed
    bool is_broken_ = false;        // the manifest has a mistake, and tree_ is older
    bool is_unreadable_ = false;    // the manifest could not be read

    // Names are relative to the root, or absolute.
    std::unique_ptr<BuildTree> tree_;
    std::unordered_multimap<std::string, std::size_t> inputs_;  // the tasks that read a file, besides those of all
    std::unordered_set<std::string> outputs_, output_folders_;
    std::unordered_set<std::string> named_;                      // files that the manifest names, and itself
    std::unordered_multimap<std::string, std::string> targets_;  // files behind links: the names of the links

    // What happened since the last build.
    bool everything_ = true;
    std::set<std::string> saved_, created_, gone_;
    Clock::time_point settled_, settled_at_last_, gone_for_good_;
};

std::string Watch::path(const std::string& name) const {
    if (is_absolute(name)) return name;
    if (options_.root.empty()) return name.empty() ? "." : name;
    return options_.root + "/" + name;
}

// `folder` is "" or ends with "/".
void Watch::add(const std::string& folder) {
    if (failure_) return;
    if (const auto added = events_.add(path(folder), folder); !added) failure_ = added.error();
}

// Watches the folder of a file or, if there is none, the nearest one around it, in which it may appear.
void Watch::add_parent_of(const std::string& file) {
    for (fs::path at = fs::path(file).parent_path(); !failure_; at = at.parent_path()) {
        std::string folder = slashed(at);
        if (!folder.empty() && !folder.ends_with('/')) folder += '/';
        const auto added = events_.add(path(folder), folder);
        if (!added) failure_ = added.error();
        if (!added || *added || at == at.parent_path()) return;
    }
}

// If the name is a link, whoever writes the file behind it changes what we read.
void Watch::add_link(const std::string& name) {
    const auto status = status_of_link(path(name));
    if (!status || status->kind != FileKind::link) return;
    std::error_code error;
    const std::string target = slashed(fs::canonical(path(name), error));
    if (error) return;
    targets_.emplace(target, name);
    add_parent_of(target);
}

// Returns nothing, and prints an error, if the manifest has a mistake.
std::unique_ptr<BuildTree> Watch::read_tree() {
    try {
        auto tree = load_([this](const std::string& folder) { add(folder); });
        if (tree) return std::move(*tree);
        console_.error(tree.error().message());
        is_unreadable_ = true;
    } catch (const UsageError& error) {
        console_.error(error.what());
    }
    return nullptr;
}

void Watch::learn_names() {
    inputs_.clear();
    outputs_.clear();
    output_folders_.clear();
    named_.clear();
    for (std::size_t k = 0; k < tree_->work.tasks.size(); ++k) {
        const BuildTask& task = tree_->work.tasks[k];
        inputs_.emplace(task.input, k);
        add_link(task.input);
        for (const std::string& part : tree_->recipes[task.recipe].own_files(task.input, path(task.input))) {
            const std::string name = slashed(fs::path(part).lexically_normal());
            inputs_.emplace(name, k);
            add_parent_of(name);
            add_link(name);
        }
        std::vector<std::string> outputs = task.outputs;
        for (std::string& file : files_of(task, tree_->recipes[task.recipe])) outputs.push_back(std::move(file));
        for (const std::string& output : outputs) {
            outputs_.insert(output);
            fs::path folder = fs::path(output).parent_path();
            while (!folder.empty() && output_folders_.insert(slashed(folder)).second) folder = folder.parent_path();
        }
    }
    for (const Recipe& recipe : tree_->recipes) {
        for (const std::string& file : recipe.files()) {
            const std::string name = slashed(fs::path(file).lexically_normal());
            if (outputs_.contains(name) || !named_.insert(name).second) continue;
            add_parent_of(name);
            add_link(name);
        }
    }
}

// Folders are watched before they are read, so that nothing is missed in between.
void Watch::load() {
    events_.begin();
    targets_.clear();
    add_parent_of(manifest_);
    add_link(manifest_);
    std::unique_ptr<BuildTree> tree = read_tree();
    is_broken_ = tree == nullptr;
    if (tree) tree_ = std::move(tree);
    if (tree_) learn_names();
    named_.insert(manifest_);
    events_.end(!is_broken_);
}

void Watch::build(const WorkList& work, bool is_part) {
    BuildOptions options = options_;
    options.is_part = is_part;
    options.lists_made = true;
    try {
        const ExitCode code = cli::build(tree_->recipes, work, options, running_, console_);
        is_abandoned_ = code != ExitCode::done && console_.host().out_is_abandoned();
    } catch (const UsageError& error) {  // names that are in each other's way
        console_.error(error.what());
    }
}

void Watch::build_what_is_due() {
    std::set<std::size_t> tasks;
    for (const auto* const names : {&saved_, &created_}) {
        for (const std::string& name : *names) {
            const auto [first, last] = inputs_.equal_range(name);
            everything_ = everything_ || first == last || named_.contains(name);
            for (auto task = first; task != last; ++task) tasks.insert(task->second);
        }
    }
    saved_.clear();
    created_.clear();
    if (!everything_ && !is_broken_) return build(part_of(tree_->work, tasks), true);
    everything_ = false;
    gone_.clear();
    load();
    if (!is_broken_ && !failure_) build(tree_->work, false);
}

bool Watch::is_input(const std::string& name) const {
    if (named_.contains(name)) return true;
    if (inputs_.contains(name) && !outputs_.contains(name)) return true;
    if (!tree_ || is_absolute(name) || outputs_.contains(name)) return false;
    return std::any_of(tree_->recipes.begin(), tree_->recipes.end(),
                       [&](const Recipe& recipe) { return recipe.takes(name); });
}

// Whether inputs are in this folder, or may be. The folders that we make for outputs and for the cache do not count.
bool Watch::is_folder_of_inputs(const std::string& name) const {
    const std::string folder = name + "/";
    const auto is_in_folder = [&](const std::string& file) { return file.starts_with(folder); };
    if (std::any_of(named_.begin(), named_.end(), is_in_folder)) return true;
    if (!tree_ || is_absolute(name)) return false;
    const std::vector<BuildTask>& tasks = tree_->work.tasks;
    if (std::any_of(tasks.begin(), tasks.end(), [&](const BuildTask& task) { return is_in_folder(task.input); }))
        return true;
    if (output_folders_.contains(name) || (!cache_.empty() && absolute(path(folder)).starts_with(cache_))) return false;
    return std::any_of(tree_->recipes.begin(), tree_->recipes.end(), [&](const Recipe& recipe) {
        return std::any_of(recipe.match().begin(), recipe.match().end(),
                           [&](const Glob& glob) { return glob.reaches(folder); });
    });
}

void Watch::note(FileEventKind kind, const std::string& name) {
    const Clock::time_point now = Clock::now();
    const bool is_first = !is_pending();
    if (kind == FileEventKind::folder) {
        if (everything_ || !is_folder_of_inputs(name)) return;
        everything_ = true;
    } else if (!is_input(name)) {
        return;
    } else if (kind == FileEventKind::gone) {
        gone_.insert(name);
        gone_for_good_ = now + kMayComeBack;
        return;
    } else {
        gone_.erase(name);
        (kind == FileEventKind::saved ? saved_ : created_).insert(name);
    }
    settled_ = now + kSettles;
    if (is_first) settled_at_last_ = now + kSettlesAtLast;
}

// When something must be built; if nothing must, when interruption() is asked again.
Clock::time_point Watch::due() const {
    Clock::time_point due = Clock::now() + kPatience;
    if (is_pending()) due = std::min({due, settled_, settled_at_last_});
    return gone_.empty() ? due : std::min(due, gone_for_good_);
}

void Watch::wait_until_due() {
    while (!ends()) {
        const auto left = std::chrono::ceil<milliseconds>(due() - Clock::now());
        std::vector<FileEvent> events;
        if (!events_.wait(static_cast<int>(std::max(left, milliseconds(0)).count()), events)) everything_ = true;
        for (const FileEvent& event : events) {
            note(event.kind, event.path);
            for (auto [link, end] = targets_.equal_range(event.path); link != end; ++link)
                note(event.kind, link->second);
        }
        const Clock::time_point now = Clock::now();
        if (!gone_.empty() && now >= gone_for_good_) everything_ = true;
        if (!everything_ && now < due()) continue;
        std::erase_if(created_, [this](const std::string& name) { return !is_complete(path(name)); });
        if (is_pending()) return;
    }
}

ExitCode Watch::run() {
    Host& host = console_.host();
    host.begin();
    if (const auto opened = events_.open(); !opened) failure_ = opened.error();
    bool is_first = true;
    while (!ends()) {
        build_what_is_due();
        if (is_first && is_unreadable_) return ExitCode::io;  // probably not the name of a manifest
        if (is_first && !ends() && !running_.json && !running_.quiet)
            std::ignore = console_.print(fmt::format("watching {} folders\n", events_.folders()));
        is_first = false;
        wait_until_due();
    }
    if (failure_) console_.error(failure_->message());
    if (!host.interruption().empty()) {  // between two builds
        if (running_.json) std::ignore = print_json_summary({}, 0, 0, true, console_);
        host.end_interrupted();
    }
    return ExitCode::io;
}

}  // namespace

ExitCode watch(const std::string& manifest, const LoadTree& load, const BuildOptions& options,
               const RunOptions& running, Console& console) {
    return Watch(manifest, load, options, running, console).run();
}

}  // namespace tex::cli
