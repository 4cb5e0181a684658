// SPDX-License-Identifier: Apache-2.0

#include "stream/unpack_stage.h"

#include <algorithm>
#include <utility>

#include "formats/picture.h"
#include "kernels/scale.h"

namespace tex::inline v1 {

namespace {

constexpr int kBlue = 2, kAlpha = 3;

}  // namespace

std::vector<bool> wanted_channels(const Sources& sources, const UnpackExtras& extras) {
    std::vector<bool> wanted(4, false);
    for (int c = 0; c < 4; ++c) {
        wanted[static_cast<std::size_t>(c)] =
            c == sources.x || c == sources.y || c == sources.z || (c == kBlue && extras.takes.blue) ||
            (c == kAlpha && extras.takes.alpha) || (extras.others != nullptr && extras.others->wants(c));
    }
    return wanted;
}

UnpackStage::UnpackStage(StoredChannels channels, const Sources& sources, const UnpackRule& rule,
                         const UnpackExtras& extras)
    : Stage(channels.rows->extent(), extras.takes), channels_(std::move(channels)), sources_(sources), rule_(rule),
      extras_(extras), wanted_(wanted_channels(sources, extras)) {}

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
    const float* const z = sources_.z < 0 ? nullptr : channels[sources_.z];
    unpack_row(channels[sources_.x], channels[sources_.y], z, rule_, width, out.x, out.y, out.z);
    if (extras_.takes.length) {
        values_of_lengths(channels[sources_.x], channels[sources_.y], z, rule_.is_unsigned, width,
                          strip.map.length.row(k));
    }
    if (extras_.takes.alpha) std::copy_n(channels[kAlpha], width, strip.map.alpha.row(k));
    if (extras_.takes.blue) std::copy_n(channels[kBlue], width, strip.map.blue.row(k));
    if (extras_.others != nullptr) extras_.others->add_row(j, channels, out, width);
    if (extras_.inspector != nullptr && extras_.inspector->wants(j)) {
        const std::lock_guard lock(inspecting_);
        extras_.inspector->add_row(j, out);
    }
    if (extras_.scale) scale_row(out, extras_.scale->scale, extras_.scale->mode, width, out);
}

}  // namespace tex::inline v1
