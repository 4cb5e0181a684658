// SPDX-License-Identifier: Apache-2.0

#include "stream/blend_stage.h"

#include <algorithm>
#include <memory>

namespace tex::inline v1 {

std::optional<RowsInStep> rows_in_step(Extent source, Extent result, const UvMap& map, Wrap wrap_x, Wrap wrap_y) {
    constexpr int kMostRows = 4;
    if (source != result || level_wanted(map, source) > 0.0) return std::nullopt;
    Sampler sampler(source, result, map, wrap_x, wrap_y);
    if (sampler.is_whole()) return RowsInStep();
    if (!sampler.is_along_rows()) return std::nullopt;
    RowsInStep step;
    for (int j = 0; j < result.height; ++j) {
        sampler.place(j);
        const Sampler::Rows rows = sampler.rows();
        for (const int row : {rows.upper, rows.lower}) {
            if (row < kMostRows && row < j - kMostRows) {
                step.head = std::max(step.head, row + 1);
            } else {
                step.behind = std::max(step.behind, j - row);
                step.ahead = std::max(step.ahead, row - j);
            }
        }
        if (step.behind > kMostRows || step.ahead > kMostRows) return std::nullopt;
    }
    return step;
}

std::vector<Need> BlendStage::needs(int first, int end) const {
    std::vector<Need> needs;
    for (const MapInStep& map : in_step_) {
        const int height = extent().height;
        if (map.step.head > 0) needs.push_back({map.rows, 0, map.step.head});
        needs.push_back({map.rows, std::max(0, first - map.step.behind), std::min(height, end + map.step.ahead)});
    }
    if (base_ != nullptr) needs.push_back({base_, first, end});
    return needs;
}

Result<void> BlendStage::make(Strip& strip) {
    const std::shared_ptr<BlendRows> rows = rows_.take([this] { return std::make_unique<BlendRows>(maps_); });
    for (int k = 0; k < strip.height; ++k) {
        rows->make(strip.first + k, strip.normals(k));
        for (const Extra extra : kExtras) {
            if (!extras()[extra]) continue;
            const float* const base = base_ != nullptr ? base_->row(plane_of(extra), strip.first + k) : nullptr;
            rows->make_extra(extra, base, strip.map[extra].row(k));
        }
    }
    return {};
}

}  // namespace tex::inline v1
