// SPDX-License-Identifier: Apache-2.0
// channel_names.h: what the channels of a format are called.

#pragma once

#include <string>
#include <vector>

#include <tex/texture.h>

namespace tex {

// The swizzle of a texture that has one channel, and that one is alpha.
inline constexpr Swizzle kAlphaAlone = {Component::zero, Component::zero, Component::zero, Component::other};

// R, G, B, A: as many as the format has channels; A where that is the only one. The texture needs no levels.
inline std::vector<std::string> channel_names(const Texture& head) {
    const auto channels = static_cast<std::size_t>(format_info(head.format).channels);
    if (channels == 1 && head.swizzle == kAlphaAlone) return {"A"};
    const char* const names[] = {"R", "G", "B", "A"};
    return {names, names + channels};
}

}  // namespace tex
