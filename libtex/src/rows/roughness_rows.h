// SPDX-License-Identifier: Apache-2.0
// roughness_rows.h: packs rows of roughness into the bytes of a texture.

#pragma once

#include <cstddef>

#include <tex/format.h>
#include <tex/pack.h>
#include <tex/types.h>

namespace tex::inline v1 {

// Does what pack_rows() (pack_rows.h) does, for one channel. Precondition: the format is one of those of
// pack_roughness().
void pack_roughness_rows(const Plane<float>& level, int height, Format format, Effort effort, int begin, int end,
                         std::byte* out);

}  // namespace tex::inline v1
