// SPDX-License-Identifier: Apache-2.0

#include "stream/unpack_stage.h"

#include <utility>

#include "formats/picture.h"
#include "kernels/scale.h"

namespace tex {

UnpackStage::UnpackStage(const TextureRows& texture, Extent extent, const Sources& sources, const UnpackRule& rule,
                         const std::optional<Scaling>& scale, LayoutFinder* finder, MapInspector* inspector,
                         NormalSink sink)
    : texture_(texture), extent_(extent), sources_(sources), rule_(rule), scale_(scale), finder_(finder),
      inspector_(inspector), sink_(std::move(sink)) {
    if (texture.rounds) rounded_ = Plane<float>(Extent{extent.width, 4});
}

void UnpackStage::put(const Image& rows, int count) {
    for (int k = 0; k < count; ++k) put_row(rows, k);
}

void UnpackStage::put_row(const Image& rows, int k) {
    const float* channels[4] = {};
    for (std::size_t c = 0; c < texture_.planes.size(); ++c) {
        channels[c] = rows.planes[texture_.planes[c]].row(k);
        if (!texture_.rounds) continue;
        float* const rounded = rounded_.row(static_cast<int>(c));
        round_to_texels(channels[c], extent_.width, rounded);
        channels[c] = rounded;
    }
    if (finder_ != nullptr) finder_->add_row(channels);
    const int j = row_++;
    const NormalRow out = sink_.place(j);
    const float* const z = sources_.z < 0 ? nullptr : channels[sources_.z];
    unpack_row(channels[sources_.x], channels[sources_.y], z, rule_, extent_.width, out.x, out.y, out.z);
    if (inspector_ != nullptr) inspector_->add_row(j, out);
    if (scale_) scale_row(out, scale_->scale, scale_->mode, extent_.width, out);
    sink_.finish(j);
}

}  // namespace tex
