// SPDX-License-Identifier: Apache-2.0

#include "stream/unpack_stage.h"

#include <utility>

#include "formats/picture.h"
#include "kernels/scale.h"

namespace tex {

UnpackStage::UnpackStage(StoredChannels channels, const Sources& sources, const UnpackRule& rule,
                         const std::optional<Scaling>& scale, MapInspector* inspector)
    : Stage(channels.rows->extent(), 3), channels_(std::move(channels)), sources_(sources), rule_(rule), scale_(scale),
      inspector_(inspector) {}

const float* UnpackStage::channel(int c, int j, float* rounded) const {
    if (c < 0) return nullptr;
    const float* const values = channels_.rows->row(static_cast<int>(channels_.planes[static_cast<std::size_t>(c)]), j);
    if (!channels_.rounds) return values;
    round_to_texels(values, extent().width, rounded);
    return rounded;
}

Result<void> UnpackStage::make(Strip& strip) {
    const int width = extent().width;
    Plane<float> rounded;
    if (channels_.rounds) rounded = Plane<float>(Extent{width, 3});
    for (int k = 0; k < strip.height; ++k) {
        const int j = strip.first + k;
        const auto values = [&](int c, int scratch) {
            return channel(c, j, channels_.rounds ? rounded.row(scratch) : nullptr);
        };
        const NormalRow out = strip.normals(k);
        unpack_row(values(sources_.x, 0), values(sources_.y, 1), values(sources_.z, 2), rule_, width, out.x, out.y,
                   out.z);
        if (inspector_ != nullptr && inspector_->wants(j)) {
            const std::lock_guard lock(inspecting_);
            inspector_->add_row(j, out);
        }
        if (scale_) scale_row(out, scale_->scale, scale_->mode, width, out);
    }
    return {};
}

}  // namespace tex
