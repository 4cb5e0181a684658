// SPDX-License-Identifier: Apache-2.0

#include "stream/unpack_stage.h"

#include <algorithm>
#include <utility>

#include "formats/picture.h"
#include "kernels/scale.h"

namespace tex::inline v1 {

std::vector<bool> wanted_channels(const Sources& sources, const UnpackPlan& plan) {
    const std::array<bool, 4> read = channels_read(sources, plan.takes);
    std::vector<bool> wanted(read.begin(), read.end());
    for (std::size_t c = 0; c < wanted.size() && plan.extra_inspector != nullptr; ++c)
        wanted[c] = wanted[c] || plan.extra_inspector->wants(static_cast<int>(c));
    return wanted;
}

UnpackStage::UnpackStage(StoredChannels channels, const Sources& sources, const UnpackRule& rule,
                         const UnpackPlan& plan)
    : Stage(channels.rows->extent(), plan.takes), channels_(std::move(channels)), sources_(sources), rule_(rule),
      plan_(plan), wanted_(wanted_channels(sources, plan)) {}

Result<void> UnpackStage::make(Strip& strip) {
    const int width = extent().width;
    Plane<float> rounded;
    if (channels_.rounds) rounded = Plane<float>(Extent{width, 4});
    for (int k = 0; k < strip.height; ++k) {
        const int j = strip.first + k;
        const float* channels[4] = {};
        for (std::size_t c = 0; c < 4; ++c) {
            if (!wanted_[c]) continue;
            channels[c] = channels_.rows->row(static_cast<int>(channels_.planes[c]), j);
            if (!channels_.rounds) continue;
            float* const row = rounded.row(static_cast<int>(c));
            round_to_texels(channels[c], width, row);
            channels[c] = row;
        }
        make_row(j, channels, strip, k);
    }
    return {};
}

void UnpackStage::make_row(int j, const float* const (&channels)[4], Strip& strip, int k) {
    const int width = extent().width;
    const NormalRow out = strip.normals(k);
    const VectorRow vectors = vectors_of(channels, sources_);
    unpack_row(vectors.x, vectors.y, vectors.z, rule_, width, out.x, out.y, out.z);
    unpack_extras(plan_.takes, vectors, rule_.is_unsigned, channels, strip.map, k);
    if (plan_.extra_inspector != nullptr) plan_.extra_inspector->add_row(j, channels, out, width);
    if (plan_.inspector != nullptr && plan_.inspector->wants(j)) {
        const std::lock_guard lock(inspecting_);
        plan_.inspector->add_row(j, out);
    }
    if (plan_.scale) scale_row(out, plan_.scale->scale, plan_.scale->mode, width, out);
}

}  // namespace tex::inline v1
