// SPDX-License-Identifier: Apache-2.0
// roughness_rows.h: packs rows of roughness into the bytes of a texture, alone or beside what its channels hold
// already.

#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <tex/format.h>
#include <tex/pack.h>
#include <tex/types.h>

namespace tex::inline v1 {

// What a texture holds: R, G, B and A of each level, from 0 to 1. A plane is empty if the texture lacks the channel.
using ChannelPlanes = std::array<Plane<float>, 4>;
struct KeptChannels {
    std::vector<ChannelPlanes> levels;
};

// Whether a roughness file may have this format: one channel, or more of these.
[[nodiscard]] bool holds_roughness(Format format);

// Whether such a format holds one value a texel, or the same one in R, G and B.
[[nodiscard]] bool is_single_roughness(Format format);

// Does what pack_rows() (pack_rows.h) does, for one channel. Precondition: is_single_roughness(format).
void pack_roughness_rows(const Plane<float>& level, int height, Format format, Effort effort, int begin, int end,
                         std::byte* out);

// Packs `height` rows of a level, which begin at row `first` of it and are rows 0 and on of `roughness`. `kept` is the
// same level, or null. Precondition: holds_roughness(format).
void pack_roughness_channels(const Plane<float>& roughness, int first, int height, const RoughnessParts& parts,
                             const ChannelPlanes* kept, Format format, Effort effort, std::byte* out);

}  // namespace tex::inline v1
