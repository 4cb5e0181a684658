// SPDX-License-Identifier: Apache-2.0

#include "stream/roughness_stage.h"

#include <cstring>
#include <utility>

#include "kernels/roughness.h"

namespace tex {

RoughnessStage::RoughnessStage(Extent base, int levels, const MipOptions& options, RoughnessModel model, float own,
                               Strips& strips)
    : model_(model), strips_(strips), own_(Extent{base.width, 2}),
      steps_(base, levels, 4, 0, options, [this](LevelStep& step, bool) { return make_row(step); }) {
    const Plane<float> given(Extent{base.width, 1}, own);
    clean_roughness(given.row(0), base.width, own_.row(0), own_.row(1));
}

void RoughnessStage::put(int j, const NormalRow& row, std::shared_ptr<const void> owner) {
    constexpr int kBase = 0;
    const auto bytes = static_cast<std::size_t>(own_.extent().width) * sizeof(float);
    std::memcpy(strips_.place(kBase, j).row.x, own_.row(0), bytes);
    strips_.finish(kBase, j);
    steps_.put(j, {{row.x, row.y, row.z, own_.row(1)}, std::move(owner)});
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
