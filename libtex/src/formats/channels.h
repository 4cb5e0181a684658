// SPDX-License-Identifier: Apache-2.0
// channels.h: the names of a format's channels, and what they hold.

#pragma once

#include <string>
#include <vector>

#include <tex/format.h>

#include "rows/codecs.h"

namespace tex::inline v1 {

// The swizzle of a texture whose only channel is alpha.
inline constexpr Swizzle kAlphaAlone = {Component::zero, Component::zero, Component::zero, Component::other};

// The names of the format's channels: the first of R, G, B, A, or only A if alpha is the only channel. The texture
// needs no levels.
inline std::vector<std::string> channel_names(const Texture& head) {
    const auto channels = static_cast<std::size_t>(format_info(head.format).channels);
    if (channels == 1 && head.swizzle == kAlphaAlone) return {"A"};
    const char* const names[] = {"R", "G", "B", "A"};
    return {names, names + channels};
}

// The likeliest swizzle of normals in this format, for files that do not state one. BC3 is taken for DXT5nm,
// ASTC for astcenc's form of normals.
inline Swizzle likely_swizzle(Format format) {
    if (const auto& usual = format_row(format).codec->swizzle) return *usual;
    switch (format_info(format).channels) {
        case 1: return {Component::other, Component::zero, Component::zero, Component::one};
        case 2: return kSwizzleXy;
        case 3: return {Component::x, Component::y, Component::z, Component::one};
        default: return kSwizzleXyz;
    }
}

}  // namespace tex::inline v1
