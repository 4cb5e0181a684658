// SPDX-License-Identifier: Apache-2.0

#include "stream/blend_stage.h"

#include <algorithm>
#include <utility>

namespace tex {

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

ArrivingMap::ArrivingMap(const TextureRows& texture, Extent extent, const Sources& sources, const UnpackRule& rule,
                         LayoutFinder* finder, MapInspector* inspector, const RowsInStep& step)
    : extent_(extent), step_(step), shelf_(extent.height, 0, {step.head, 0, false}), rows_(extent.width, 3),
      unpack_(texture, extent, sources, rule, std::nullopt, finder, inspector, sink()) {}

NormalSink ArrivingMap::sink() {
    return {[this](int) {
                row_ = rows_.make();
                return NormalRow{row_->row(0), row_->row(1), row_->row(2)};
            },
            [this](int j) {
                shelf_.put(j, {{row_->row(0), row_->row(1), row_->row(2)}, std::move(row_)});
            }};
}

bool ArrivingMap::is_ready(int j) const { return shelf_.has(std::min(j + step_.ahead, extent_.height - 1)); }

VectorRow ArrivingMap::row(int j) const {
    const ShelfRow& row = shelf_.at(j);
    return {row.planes[0], row.planes[1], row.planes[2]};
}

BlendStage::BlendStage(const PlacedMaps& maps, std::vector<ArrivingMap*> arriving, NormalSink sink)
    : arriving_(std::move(arriving)), sink_(std::move(sink)), blend_(maps) {}

void BlendStage::put(const Image& rows, int count) {
    arrived_ += count;
    for (ArrivingMap* const map : arriving_) map->put(rows, count);
    const auto is_ready = [this] {
        return next_ < arrived_ && std::all_of(arriving_.begin(), arriving_.end(),
                                               [this](const ArrivingMap* map) { return map->is_ready(next_); });
    };
    for (; is_ready(); ++next_) {
        blend_.make(next_, sink_.place(next_));
        sink_.finish(next_);
        for (ArrivingMap* const map : arriving_) map->release(next_);
    }
}

}  // namespace tex
