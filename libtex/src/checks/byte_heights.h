// SPDX-License-Identifier: Apache-2.0
// byte_heights.h: colours that are the bytes of heights, as map servers send them.

#pragma once

#include <optional>

#include <tex/height.h>

#include "checks/stored.h"

namespace tex::inline v1 {

// How R, G and B hold heights: terrain_rgb or terrarium; nothing if they are something else, or if it does not show.
// Precondition: the picture has 8 bits a channel.
std::optional<HeightChannel> byte_heights(const Image& image);

}  // namespace tex::inline v1
