// SPDX-License-Identifier: Apache-2.0

#include "stream/flow_plan.h"

#include <numeric>

#include "blocks/extent.h"

namespace tex::inline v1 {

int Stage::choose_strip_rows(int texels, int together) const {
    const std::int64_t base_width = static_cast<std::int64_t>(extent_.width) << level_;
    const int rows = static_cast<int>(texels / base_width) >> level_;
    return std::max(together, rows / together * together);
}

std::unique_ptr<Strip> Stage::new_strip(int rows) const {
    auto strip = std::make_unique<Strip>();
    const Extent extent{extent_.width, rows};
    if (planes_ == 1) strip->map.x = Plane<float>(extent);
    if (planes_ > 1) strip->map = NormalMap(extent);
    add_planes(strip->map, extras_);
    return strip;
}

FlowPlan::FlowPlan(const std::vector<std::unique_ptr<Stage>>& stages, int texels, int together) {
    divide(stages, texels, together);
    plan_reading();
    link();
    plan_writing();
}

// Divides the stages into strips.
void FlowPlan::divide(const std::vector<std::unique_ptr<Stage>>& stages, int texels, int together) {
    int task = 0;
    for (const std::unique_ptr<Stage>& each : stages) {
        Stage& stage = *each;
        const int rows = stage.extent().height - stage.begin();
        stage.strip_rows_ = stage.choose_strip_rows(texels, together);
        stage.held_rows_ = std::min(stage.strip_rows_, whole_blocks(rows, together));
        stage.line_ = lines.size();
        Line line{&stage, task, (rows + stage.strip_rows_ - 1) / stage.strip_rows_, false, {}};
        stage.made_.assign(static_cast<std::size_t>(line.count), nullptr);
        line.ready.reserve(static_cast<std::size_t>(line.count));
        task += line.count;
        lines.push_back(std::move(line));
    }
    waits.assign(static_cast<std::size_t>(task), 0);
    users.assign(static_cast<std::size_t>(task), 0);
}

// Finds out in which order strips are read: the stage that is farthest behind comes first.
void FlowPlan::plan_reading() {
    std::vector<std::pair<double, int>> order;
    for (const Line& line : lines) {
        if (!line.stage->reads()) continue;
        for (int k = 0; k < line.count; ++k) order.emplace_back(static_cast<double>(k) / line.count, line.first + k);
        strip_texels = std::max(strip_texels, line.texels_of(line.first));
    }
    std::sort(order.begin(), order.end());
    reads_of_.assign(waits.size(), 0);
    for (std::size_t k = 0; k < order.size(); ++k)
        reads_of_[static_cast<std::size_t>(order[k].second)] = static_cast<int>(k) + 1;
}

// Finds out which task waits for which. What a stage needs comes before it.
void FlowPlan::link() {
    Pairs pairs;  // a task, and one that waits for it
    for (Line& line : lines) {
        for (int task = line.first; task < line.first + line.count; ++task) {
            const std::size_t begin = before_.size();
            link_before(line, task);
            for (std::size_t k = begin; k < before_.size(); ++k) pairs.emplace_back(before_[k], task);
        }
        if (line.stage->in_order()) link_in_order(line, pairs);
    }
    before_begin_.push_back(static_cast<int>(before_.size()));
    link_after(pairs);
    for (Line& line : lines) {
        const auto first = users.begin() + line.first;
        line.is_target = std::all_of(first, first + line.count, [](int count) { return count == 0; });
    }
}

void FlowPlan::link_in_order(const Line& line, Pairs& pairs) const {
    std::vector<int> tasks(static_cast<std::size_t>(line.count));
    std::iota(tasks.begin(), tasks.end(), line.first);
    std::stable_sort(tasks.begin(), tasks.end(), [this](int a, int b) {
        return reads_of_[static_cast<std::size_t>(a)] < reads_of_[static_cast<std::size_t>(b)];
    });
    for (std::size_t k = 1; k < tasks.size(); ++k) pairs.emplace_back(tasks[k - 1], tasks[k]);
}

// Finds the tasks whose strips a task needs.
void FlowPlan::link_before(const Line& line, int task) {
    const std::size_t begin = before_.size();
    before_begin_.push_back(static_cast<int>(begin));
    const int first = line.row_of(task);
    for (const Need& need : line.stage->needs(first, first + line.rows_of(task))) {
        const Line& from = lines[need.stage->line_];
        const int rows = need.stage->strip_rows_, top = need.stage->begin();
        for (int k = (need.first - top) / rows; k <= (need.end - 1 - top) / rows; ++k)
            before_.push_back(from.first + k);
    }
    const auto mine = before_.begin() + static_cast<std::ptrdiff_t>(begin);
    std::sort(mine, before_.end());
    before_.erase(std::unique(mine, before_.end()), before_.end());
    int& reads = reads_of_[static_cast<std::size_t>(task)];
    for (std::size_t k = begin; k < before_.size(); ++k) {
        ++users[static_cast<std::size_t>(before_[k])];
        reads = std::max(reads, reads_of_[static_cast<std::size_t>(before_[k])]);
    }
}

void FlowPlan::link_after(const Pairs& pairs) {
    after_begin_.assign(waits.size() + 1, 0);
    for (const auto& [task, waiting] : pairs) {
        ++after_begin_[static_cast<std::size_t>(task) + 1];
        ++waits[static_cast<std::size_t>(waiting)];
    }
    for (std::size_t k = 0; k + 1 < after_begin_.size(); ++k) after_begin_[k + 1] += after_begin_[k];
    after_.resize(pairs.size());
    std::vector<int> next(after_begin_.begin(), after_begin_.end() - 1);
    for (const auto& [task, waiting] : pairs)
        after_[static_cast<std::size_t>(next[static_cast<std::size_t>(task)]++)] = waiting;
}

// Finds out in which order strips of targets can be made.
void FlowPlan::plan_writing() {
    for (const Line& line : lines) {
        for (int task = line.first; line.is_target && task < line.first + line.count; ++task) {
            due.push_back({reads_of_[static_cast<std::size_t>(task)], task, line.texels_of(task)});
            target_texels += line.texels_of(task);
        }
    }
    std::sort(due.begin(), due.end(),
              [](const Due& a, const Due& b) { return a.reads != b.reads ? a.reads < b.reads : a.task < b.task; });
    due_of.assign(waits.size(), 0);
    for (std::size_t k = 0; k < due.size(); ++k) due_of[static_cast<std::size_t>(due[k].task)] = static_cast<int>(k);
}

std::size_t FlowPlan::line_of(int task) const {
    const auto after = std::upper_bound(lines.begin(), lines.end(), task,
                                        [](int wanted, const Line& line) { return wanted < line.first; });
    return static_cast<std::size_t>(after - lines.begin()) - 1;
}

}  // namespace tex::inline v1
