// SPDX-License-Identifier: Apache-2.0

#include "tree/merge.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "cli/json.h"
#include "cli/text.h"
#include "cli/text_file.h"
#include "cli/usage_error.h"
#include "tree/json_line.h"
#include "tree/shard_report.h"

namespace tex::cli {
namespace {

enum class Fate { done, missing, contradicted, lost, failed };

constexpr Named<Fate> kFateNames[] = {
    {Fate::done, "done", ""},
    {Fate::missing, "missing", "no report has it"},
    {Fate::contradicted, "contradicted", "two reports say different things about its outputs"},
    {Fate::lost, "lost", "an output is not what the report says"},
    {Fate::failed, "failed", "it could not be made"},
};

// What is known of a texture.
struct TextureFate {
    Fate fate = Fate::missing;
    bool is_sent_again = true;
    std::string reason;
    std::string report;  // that says so
    std::vector<std::pair<std::string, OutputRecord>> outputs;
};

class Merge {
public:
    Merge(const FarmPlan& plan, const std::vector<Recipe>& recipes, const BuildOptions& options,
          const RunOptions& running, Console& console)
        : plan_(plan), recipes_(recipes), options_(options), running_(running), console_(console),
          textures_(plan.tasks.size()), contents_(options.root, state_.memos) {
        if (const auto text = read_text_file(options.state_file, kMostOfRecord)) state_ = BuildState::parse(*text);
        for (std::size_t k = 0; k < plan.tasks.size(); ++k) {
            index_.emplace(plan.tasks[k].input, k);
            if (!plan.tasks[k].refusal.empty()) textures_[k] = {Fate::failed, false, plan.tasks[k].refusal, {}, {}};
        }
    }

    ExitCode run(const std::vector<std::string>& reports) {
        for (const std::string& path : reports) read(path);
        if (shards_ == 0) {
            console_.error("there is no report of this plan; send all shards again");
            return std::max(code_, ExitCode::io);
        }
        verify();
        follow_needs();
        save();
        return print();
    }

private:
    void read(const std::string& path);
    void take(const std::string& path, ShardRecord record);
    void fail(ExitCode code, const std::string& message) {
        console_.error(message);
        code_ = std::max(code_, code);
    }
    void verify();
    void follow_needs();
    void save();
    [[nodiscard]] ExitCode print();
    void print_texture(const TextureFate& texture, const std::string& input, int shard, std::string& lines);

    [[nodiscard]] bool are_named_by_rule(const BuildTask& task, const ShardRecord& record) const;

    const FarmPlan& plan_;
    const std::vector<Recipe>& recipes_;
    const BuildOptions& options_;
    const RunOptions& running_;
    Console& console_;
    std::vector<TextureFate> textures_;
    std::unordered_map<std::string, std::size_t> index_;  // of each input
    BuildState state_;
    Contents contents_;
    std::set<int> reported_;
    std::string first_;  // the first report
    int shards_ = 0;
    std::size_t repeated_ = 0;
    ExitCode code_ = ExitCode::done;
};

void Merge::read(const std::string& path) {
    std::error_code ignored;
    if (path != "-" && !std::filesystem::exists(path, ignored)) return;  // its shard has not reported
    const auto text = read_text_file(path, kMostOfRecord);
    if (!text) return fail(ExitCode::io, text.error().message());
    ShardReport report;
    try {
        report = parse_shard_report(path, *text);
    } catch (const UsageError& error) {
        return fail(ExitCode::data, fmt::format("{}; the report is not used", error.what()));
    }
    if (report.plan != plan_.digest) {
        console_.warning(fmt::format("{} is of another plan and is not used", path));
        return;
    }
    if (shards_ != 0 && shards_ != report.shards) {
        throw UsageError(fmt::format("{} is one of {} shards, but {} is one of {}; merge those of one number", first_,
                                     shards_, path, report.shards));
    }
    if (shards_ == 0) first_ = path;
    shards_ = report.shards;
    reported_.insert(report.shard);
    for (ShardRecord& record : report.records) take(path, std::move(record));
}

// Whether the files are those that the manifest gives to the outputs: a report may come from anywhere.
bool Merge::are_named_by_rule(const BuildTask& task, const ShardRecord& record) const {
    for (std::size_t k = 0; k < record.outputs.size(); ++k) {
        std::vector<std::string> names;
        for (const auto& [name, digest] : record.outputs[k].second.files) names.push_back(name);
        if (!recipes_[task.recipe].are_files_of(task.input, k, names)) return false;
    }
    return true;
}

void Merge::take(const std::string& path, ShardRecord record) {
    const auto found = index_.find(record.input);
    const std::string input = printable(record.input);
    if (found == index_.end())
        return fail(ExitCode::data, fmt::format("{}: {} is not in the plan; the record is not used", path, input));
    TextureFate& texture = textures_[found->second];
    if (!record.is_made) {
        if (texture.fate == Fate::missing)
            texture = {Fate::failed, record.may_succeed, std::move(record.reason), path, {}};
        return;
    }
    std::vector<std::string> outputs;
    for (const auto& [name, made] : record.outputs) outputs.push_back(name);
    if (outputs == plan_.tasks[found->second].outputs && !are_named_by_rule(plan_.tasks[found->second], record))
        return fail(ExitCode::data,
                    fmt::format("{}: {} has files that its rule does not make; the record is not used", path, input));
    if (outputs != plan_.tasks[found->second].outputs)
        return fail(ExitCode::data,
                    fmt::format("{}: {} has other outputs than in the plan; the record is not used", path, input));
    if (texture.fate == Fate::missing || texture.fate == Fate::failed) {
        texture = {Fate::done, true, {}, path, std::move(record.outputs)};
        return;
    }
    ++repeated_;
    for (std::size_t k = 0; k < outputs.size() && texture.fate == Fate::done; ++k) {
        const OutputRecord &a = texture.outputs[k].second, &b = record.outputs[k].second;
        if (a == b) continue;
        texture.fate = Fate::contradicted;
        const bool is_same = a.settings == b.settings && a.inputs == b.inputs;
        texture.reason =
            fmt::format("{} and {} contradict each other: {} was made {}", texture.report, path,
                        printable(with_level(outputs[k], 0)),
                        is_same ? "of the same contents and has different bytes" : "of different contents");
    }
}

// Compares the outputs with the reports.
void Merge::verify() {
    tbb::task_arena arena(running_.threads > 0 ? running_.threads : tbb::task_arena::automatic);
    arena.execute([&] {
        tbb::parallel_for(std::size_t{0}, textures_.size(), [&](std::size_t k) {
            TextureFate& texture = textures_[k];
            if (texture.fate != Fate::done) return;
            for (const auto& [name, made] : texture.outputs) {
                for (const auto& [file, digest] : made.files) {
                    const auto now = contents_.digest(file);
                    if (now && *now == digest) continue;
                    texture.fate = Fate::lost;
                    texture.reason = fmt::format(
                        "{} {}", printable(file),
                        now ? "is not what " + texture.report + " says" : "cannot be read: " + now.error().reason);
                }
            }
        });
    });
}

// What failed only because another texture was not made may succeed together with it.
void Merge::follow_needs() {
    for (bool has_changed = true; has_changed;) {
        has_changed = false;
        for (std::size_t k = 0; k < textures_.size(); ++k) {
            if (textures_[k].fate != Fate::failed || textures_[k].is_sent_again) continue;
            for (const std::size_t needed : plan_.tasks[k].needs) {
                const TextureFate& other = textures_[needed];
                if (other.fate == Fate::done || !other.is_sent_again) continue;
                textures_[k].is_sent_again = has_changed = true;
            }
        }
    }
}

// The next run of build-normals goes on from here. Shards leave the state file alone, so that they need not share it.
void Merge::save() {
    for (std::size_t k = 0; k < textures_.size(); ++k) {
        if (textures_[k].fate == Fate::done) {
            for (const auto& [name, made] : textures_[k].outputs) state_.outputs[name] = made;
        } else if (textures_[k].fate == Fate::contradicted) {
            for (const std::string& name : plan_.tasks[k].outputs) state_.outputs.erase(name);
        }
    }
    WriteOptions write;
    write.sync = false;
    write.follow_links = false;
    if (const auto saved = write_text_file(options_.state_file, state_.text(BuildState::Memos::all), write); !saved)
        console_.warning(fmt::format("{}; the next run will make everything again", saved.error().message()));
}

void Merge::print_texture(const TextureFate& texture, const std::string& input, int shard, std::string& lines) {
    const bool is_silent = texture.fate == Fate::missing && !reported_.contains(shard);
    if (running_.json) {
        Json line = {{"input", name_json(input)}, {"status", name_of(kFateNames, texture.fate)}};
        if (shard > 0) line["shard"] = shard;
        line["again"] = texture.is_sent_again;
        if (!texture.reason.empty()) line["reason"] = texture.reason;
        lines += to_report_line(line);
    }
    if (texture.fate == Fate::missing && !is_silent)
        console_.error(fmt::format("{}: missing in the report of shard {}", printable(input), shard));
    if (texture.fate != Fate::missing) {
        const bool names_input = texture.reason.starts_with(input);
        console_.error(names_input ? texture.reason : fmt::format("{}: {}", printable(input), texture.reason));
    }
    const bool is_for_good = !texture.is_sent_again || texture.fate == Fate::contradicted;
    code_ = std::max(code_, is_for_good ? ExitCode::data : ExitCode::findings);
}

ExitCode Merge::print() {
    std::vector<int> owner(textures_.size(), 0);  // the first shard that has the texture
    const auto dealt = plan_.dealt(shards_);
    for (std::size_t shard = dealt.size(); shard-- > 0;) {
        for (const std::size_t k : dealt[shard]) owner[k] = static_cast<int>(shard) + 1;
    }
    std::set<int> again;
    std::map<int, std::size_t> silent;  // textures of shards that have not reported
    std::size_t left = 0;
    std::string lines;
    for (std::size_t k = 0; k < textures_.size(); ++k) {
        const TextureFate& texture = textures_[k];
        if (texture.fate == Fate::done) continue;
        ++left;
        if (texture.is_sent_again) again.insert(owner[k]);
        if (texture.fate == Fate::missing && !reported_.contains(owner[k])) ++silent[owner[k]];
        print_texture(texture, plan_.tasks[k].input, owner[k], lines);
    }
    for (const auto& [shard, count] : silent)
        console_.error(fmt::format("shard {} has not reported; textures missing: {}", shard, count));
    const std::vector<int> numbers(again.begin(), again.end());
    const std::string list = fmt::format("{}", fmt::join(numbers, ","));
    if (running_.json) {
        lines += to_report_line({{"shards", shards_},
                                 {"textures", textures_.size()},
                                 {"done", textures_.size() - left},
                                 {"repeated", repeated_},
                                 {"again", numbers}});
        return std::max(code_, console_.print(lines));
    }
    if (left > 0) {
        console_.error(
            fmt::format("not made: {} of {} textures; {}", left, textures_.size(),
                        list.empty() ? "sending shards again would not help" : "send these shards again: " + list));
    }
    return list.empty() ? code_ : std::max(code_, console_.print(list + "\n"));
}

}  // namespace

ExitCode merge_reports(const FarmPlan& plan, const std::vector<Recipe>& recipes,
                       const std::vector<std::string>& reports, const BuildOptions& options, const RunOptions& running,
                       Console& console) {
    return Merge(plan, recipes, options, running, console).run(reports);
}

}  // namespace tex::cli
