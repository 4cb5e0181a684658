// SPDX-License-Identifier: Apache-2.0

#include "stream/level_stage.h"

#include <cstring>
#include <utility>

#include "kernels/mip.h"

namespace tex {
LevelStage::LevelStage(Extent base, int levels, int start, const MipOptions& options, Strips& strips)
    : options_(options), strips_(strips), width_(base.width) {
    if (options.domain == MipDomain::slope && levels > 1) slopes_ = std::make_unique<RowMaker>(base.width, 2);
    for (int k = 0; k + 1 < levels; ++k) {
        steps_.push_back(std::make_unique<LevelStep>(level_extent(base, k), k, 3, start, options));
        start = steps_.back()->start();
    }
}

void LevelStage::put(int j, const NormalRow& row, std::shared_ptr<const void> owner) {
    if (steps_.empty()) return;
    if (!slopes_) return put_row(0, j, {{row.x, row.y, row.z}, std::move(owner)});
    const std::shared_ptr<Plane<float>> slopes = slopes_->make();
    slopes_of_vectors(row.x, row.y, row.z, width_, slopes->row(0), slopes->row(1));
    put_row(0, j, {{slopes->row(0), slopes->row(1), nullptr}, slopes});
}

void LevelStage::put_row(std::size_t k, int j, ShelfRow row) {
    LevelStep& step = *steps_[k];
    step.shelf.put(j, std::move(row));
    while (step.is_ready()) make_row(k);
}

// The averages stay until the next level has been made of them; what is stored is a finished copy.
void LevelStage::make_row(std::size_t k) {
    LevelStep& step = *steps_[k];
    const int j = step.row();
    const int width = step.to.width;
    const int planes = options_.domain == MipDomain::vector ? 3 : 2;
    const bool last = k + 1 == steps_.size();
    const Strips::Place place = strips_.place(step.to_level, j);
    const NormalRow& stored = place.row;
    float* const outs[3] = {stored.x, stored.y, stored.z};
    ShelfRow averages;
    for (int plane = 0; plane < planes; ++plane) {
        const float* const* window = step.window(plane);
        if (step.halves) {
            halve_rows(window[0], window[1], width, outs[plane]);
        } else {
            step.filter.make(window, j, outs[plane]);
        }
    }
    if (!last) {
        const std::shared_ptr<Plane<float>> kept = step.rows.make();
        for (int plane = 0; plane < planes; ++plane) {
            std::memcpy(kept->row(plane), outs[plane], static_cast<std::size_t>(width) * sizeof(float));
            averages.planes[plane] = kept->row(plane);
        }
        averages.owner = kept;
    }
    finish_row(stored, width, options_.domain, fade_at(options_.fade, step.to_level));
    strips_.finish(step.to_level, j);
    step.advance();
    if (!last) put_row(k + 1, j, std::move(averages));
}

}  // namespace tex
