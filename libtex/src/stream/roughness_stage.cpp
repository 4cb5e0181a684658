// SPDX-License-Identifier: Apache-2.0

#include "stream/roughness_stage.h"

#include <utility>

#include "kernels/roughness.h"

namespace tex {

RoughnessStage::RoughnessStage(Extent base, int levels, const MipOptions& options, RoughnessModel model,
                               const OwnRoughness& own, Strips& strips)
    : model_(model), strips_(strips), own_(own), alpha2_(base.width, 1),
      steps_(base, levels, 4, 0, options, [this](LevelStep& step, bool) { return make_row(step); }) {}

void RoughnessStage::put(int j, const NormalRow& row, std::shared_ptr<const void> owner) {
    constexpr int kBase = 0;
    const std::shared_ptr<Plane<float>> alpha2 = alpha2_.make();
    own_.row(j, strips_.place(kBase, j).row.x, alpha2->row(0));
    strips_.finish(kBase, j);
    auto both = std::make_shared<const std::pair<std::shared_ptr<const void>, std::shared_ptr<const void>>>(
        std::move(owner), alpha2);
    steps_.put(j, {{row.x, row.y, row.z, alpha2->row(0)}, std::move(both)});
}

ShelfRow RoughnessStage::make_row(LevelStep& step) {
    const int j = step.row();
    const std::shared_ptr<Plane<float>> made = step.rows.make();
    ShelfRow averages;
    for (int plane = 0; plane < 4; ++plane) {
        step.maker.make(step.window(plane), j, made->row(plane));
        averages.planes[plane] = made->row(plane);
    }
    averages.owner = made;
    roughness_of_averages(model_, made->row(0), made->row(1), made->row(2), made->row(3), step.to.width,
                          strips_.place(step.to_level, j).row.x);
    strips_.finish(step.to_level, j);
    return averages;
}

}  // namespace tex
