// SPDX-License-Identifier: Apache-2.0
// astc.h: encodes blocks of ASTC with low dynamic range through libastcenc. No other code knows that library. (For
// decoding, see astc_decode.h.)
//
// libastcenc is compiled without vector instructions in Debian, so that its bytes do not depend on the processor. Its
// contexts take about 10 ms to make and 4 to 10 MB each. They wait for the next rows of the same format.

#pragma once

#include <cstddef>

#include <tex/format.h>
#include <tex/pack_options.h>

namespace tex {

[[nodiscard]] constexpr bool is_astc(Format format) {
    return format >= Format::astc_4x4_unorm && format <= Format::astc_12x12_unorm;
}

// Encodes a row of blocks. `xy` holds the texels of the row: x and y of a normal for each, from -1 to 1,
// `extent.height` rows of `extent.width` texels. The height is that of a block, or less at the end of a level: blocks
// then repeat the last texels. x becomes R, G and B, and y becomes A, as astcenc's mode for normal maps expects: it
// minimises the error of both, and rebuilds z. Throws std::bad_alloc.
void encode_astc(Format format, Effort effort, const float* xy, Extent extent, std::byte* blocks);

}  // namespace tex
