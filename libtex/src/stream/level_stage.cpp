// SPDX-License-Identifier: Apache-2.0

#include "stream/level_stage.h"

#include <cstring>
#include <utility>

#include "kernels/mip.h"

namespace tex {

LevelStage::LevelStage(Extent base, int levels, int start, const MipOptions& options, Strips& strips)
    : options_(options), strips_(strips), width_(base.width),
      steps_(base, levels, 3, start, options, [this](LevelStep& step, bool last) { return make_row(step, last); }) {
    if (options.domain == MipDomain::slope && levels > 1) slopes_ = std::make_unique<RowMaker>(base.width, 2);
}

void LevelStage::put(int j, const NormalRow& row, std::shared_ptr<const void> owner) {
    if (steps_.empty()) return;
    if (!slopes_) return steps_.put(j, {{row.x, row.y, row.z}, std::move(owner)});
    const std::shared_ptr<Plane<float>> slopes = slopes_->make();
    slopes_of_vectors(row.x, row.y, row.z, width_, slopes->row(0), slopes->row(1));
    steps_.put(j, {{slopes->row(0), slopes->row(1), nullptr}, slopes});
}

// Keeps the averages until the next level has been made from them, and stores a finished copy.
ShelfRow LevelStage::make_row(LevelStep& step, bool last) {
    const int j = step.row();
    const int width = step.to.width;
    const int planes = options_.domain == MipDomain::vector ? 3 : 2;
    const Strips::Place place = strips_.place(step.to_level, j);
    float* const outs[3] = {place.row.x, place.row.y, place.row.z};
    for (int plane = 0; plane < planes; ++plane) step.maker.make(step.window(plane), j, outs[plane]);
    ShelfRow averages;
    if (!last) {
        const std::shared_ptr<Plane<float>> kept = step.rows.make();
        for (int plane = 0; plane < planes; ++plane) {
            std::memcpy(kept->row(plane), outs[plane], static_cast<std::size_t>(width) * sizeof(float));
            averages.planes[plane] = kept->row(plane);
        }
        averages.owner = kept;
    }
    finish_row(place.row, width, options_, step.to_level);
    strips_.finish(step.to_level, j);
    return averages;
}

}  // namespace tex
