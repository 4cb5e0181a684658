// SPDX-License-Identifier: Apache-2.0
// six_values.h: finds BC4 palettes of 6 values for texels of which some have the lowest or the greatest code.
//
// The other texels are on the palette, or near it if they were rounded after they were decoded. So the least and the
// greatest of them are two of its six entries. Each of the fifteen pairs gives endpoints by least squares, and the best
// of these move by single codes.

#pragma once

#include "blocks/bc4.h"

namespace tex::inline v1 {

// The endpoints with the least squared error among these and `fitted`.
[[nodiscard]] Bc4Endpoints with_six_values(const BlockTexels& texels, Bc4Codes codes, Bc4Endpoints fitted);

}  // namespace tex::inline v1
