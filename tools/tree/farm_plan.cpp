// SPDX-License-Identifier: Apache-2.0

#include "tree/farm_plan.h"

#include <algorithm>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <tex/file.h>

#include "cli/text.h"
#include "cli/usage_error.h"
#include "cli/value.h"
#include "tasks/name_pattern.h"
#include "tree/json_line.h"

namespace tex::cli {
namespace {

constexpr std::int64_t kMost = std::int64_t{1} << 52;  // JSON's readers keep integers up to 2^53 exactly

// Only the reader process knows the extents of other types, and to start it for each file would take longer than to
// guess: a JPEG has about a quarter of a byte for each texel, the others about three bytes.
std::int64_t guessed_texels(const BuildTask& task) {
    return container_of(task.input) == Container::jpeg ? 4 * task.size : task.size / 3;
}

BuildTask read_task(const JsonLine& line, std::int64_t& cost) {
    BuildTask task;
    task.input = line.name("input");
    task.recipe = static_cast<std::size_t>(line.number("rule", 1, 1 << 20)) - 1;
    for (const std::string& output : line.names("outputs")) task.outputs.push_back(marked_name(output));
    task.size = line.number("bytes", 0, kMost);
    cost = line.number("cost", 1, kMost);
    if (line.has("error")) task.refusal = line.text("error");
    return task;
}

// Resolves the names of what each task needs.
class Needs {
public:
    void add(std::size_t task, std::vector<std::string> names) { names_.emplace_back(task, std::move(names)); }

    void resolve(FarmPlan& plan) {
        std::unordered_map<std::string, std::size_t> index;
        for (std::size_t k = 0; k < plan.tasks.size(); ++k) index.emplace(plan.tasks[k].input, k);
        for (const auto& [task, names] : names_) {
            for (const std::string& name : names) {
                const auto found = index.find(name);
                if (found == index.end())
                    throw UsageError(fmt::format("{}: {} needs {}, which is not in the plan", plan.path,
                                                 printable(plan.tasks[task].input), printable(name)));
                plan.tasks[task].needs.push_back(found->second);
            }
        }
        states_.assign(plan.tasks.size(), State::unknown);
        for (std::size_t k = 0; k < plan.tasks.size(); ++k) check_cycle(plan, k, 0);
    }

private:
    enum class State : char { unknown, open, good };

    void check_cycle(const FarmPlan& plan, std::size_t task, int depth) {
        constexpr int kDeepest = 1000;  // no manifest has so many rules that need each other
        if (states_[task] == State::good) return;
        if (states_[task] == State::open || depth > kDeepest)
            throw UsageError(fmt::format("{}: {} needs itself", plan.path, printable(plan.tasks[task].input)));
        states_[task] = State::open;
        for (const std::size_t needed : plan.tasks[task].needs) check_cycle(plan, needed, depth + 1);
        states_[task] = State::good;
    }

    std::vector<std::pair<std::size_t, std::vector<std::string>>> names_;
    std::vector<State> states_;
};

}  // namespace

std::vector<std::int64_t> costs_of(const std::vector<BuildTask>& tasks, const std::string& folder,
                                   const RunOptions& running) {
    std::vector<std::int64_t> costs(tasks.size());
    tbb::task_arena arena(running.threads > 0 ? running.threads : tbb::task_arena::automatic);
    arena.execute([&] {
        tbb::parallel_for(std::size_t{0}, tasks.size(), [&](std::size_t k) {
            const std::string& input = tasks[k].input;
            const auto extent = probe(folder.empty() ? input : folder + "/" + input, running.read);
            const std::int64_t texels = extent ? extent->texels() : guessed_texels(tasks[k]);
            const auto outputs = static_cast<std::int64_t>(tasks[k].outputs.size());
            costs[k] = std::clamp(texels * std::max<std::int64_t>(outputs, 1), std::int64_t{1}, kMost);
        });
    });
    return costs;
}

std::string FarmPlan::text() const {
    Json head = {{"plan", 1}, {"tool", tool}, {"output-version", output_version}, {"manifest", name_json(manifest)}};
    if (!root.empty()) head["root"] = name_json(root);
    head["manifest-sha256"] = manifest_digest.hex();
    head["textures"] = tasks.size();
    std::string text = to_line(head);
    for (std::size_t k = 0; k < tasks.size(); ++k) {
        const BuildTask& task = tasks[k];
        std::vector<std::string> outputs;
        for (const std::string& output : task.outputs) outputs.push_back(written_name(output));
        Json line = {{"input", name_json(task.input)},
                     {"rule", task.recipe + 1},
                     {"outputs", names_json(outputs)},
                     {"bytes", task.size},
                     {"cost", costs[k]}};
        if (!task.needs.empty()) {
            std::vector<std::string> needs;
            for (const std::size_t needed : task.needs) needs.push_back(tasks[needed].input);
            line["needs"] = names_json(needs);
        }
        if (!task.refusal.empty()) line["error"] = printable(task.refusal);
        text += to_line(line);
    }
    return text;
}

std::vector<std::vector<std::size_t>> FarmPlan::dealt(int shards) const {
    std::vector<DealtTexture> textures(tasks.size());
    for (std::size_t k = 0; k < tasks.size(); ++k) textures[k] = {costs[k], tasks[k].needs, !tasks[k].refusal.empty()};
    return deal(textures, shards);
}

FarmPlan parse_farm_plan(const std::string& path, std::string_view text) {
    FarmPlan plan;
    plan.path = path;
    plan.digest = digest_of(text);
    std::vector<std::string> lines = split(text, '\n');
    if (lines.back().empty()) lines.pop_back();
    if (lines.empty()) throw UsageError(path + ": is empty; make the plan again");
    const JsonLine head(path, 1, lines.front());
    if (!head.has("plan")) head.fail("is no plan of build-normals");
    if (head.number("plan", 1, 1 << 20) != 1) head.fail("a later version of build-normals has made this plan");
    plan.tool = head.text("tool");
    plan.output_version = static_cast<int>(head.number("output-version", 1, 1 << 20));
    plan.manifest = head.name("manifest");
    if (head.has("root")) plan.root = head.name("root");
    plan.manifest_digest = head.digest("manifest-sha256");
    if (head.number("textures", 0, kMost) != static_cast<std::int64_t>(lines.size()) - 1)
        head.fail(fmt::format("\"textures\" is not {}, the number of the lines that follow", lines.size() - 1));
    Needs needs;
    for (std::size_t k = 1; k < lines.size(); ++k) {
        const JsonLine line(path, k + 1, lines[k]);
        std::int64_t cost = 1;
        plan.tasks.push_back(read_task(line, cost));
        plan.costs.push_back(cost);
        if (k > 1 && plan.tasks[k - 2].input >= plan.tasks[k - 1].input) line.fail("is not sorted by \"input\"");
        if (line.has("needs")) needs.add(k - 1, line.names("needs"));
    }
    needs.resolve(plan);
    return plan;
}

}  // namespace tex::cli
