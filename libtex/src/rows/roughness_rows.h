// SPDX-License-Identifier: Apache-2.0
// roughness_rows.h: rows of roughness to the bytes of a texture.

#pragma once

#include <cstddef>

#include <tex/format.h>
#include <tex/image.h>
#include <tex/pack.h>

namespace tex {

// As pack_rows() (pack_rows.h) of one channel. Precondition: one of the formats of pack_roughness().
void pack_roughness_rows(const Plane<float>& level, int height, Format format, Effort effort, int begin, int end,
                         std::byte* out);

}  // namespace tex
