// SPDX-License-Identifier: Apache-2.0
// unpack.h: the bytes of a texture, or a picture, to normals.

#pragma once

#include <tex/execution.h>
#include <tex/mip_chain.h>
#include <tex/result.h>
#include <tex/texture.h>
#include <tex/unpack_options.h>

#pragma GCC visibility push(default)
namespace tex {

// Decodes one level to float planes, one for each channel of the format, named R, G, B, A (only A if the swizzle states
// that the only channel is alpha): [0, 1] for unorm, [-1, 1] for snorm, unchanged for floats. Block formats decode by
// these rules, not by those of a particular GPU: 5- and 6-bit endpoints are widened to 8 bits by bit replication,
// palettes interpolate with exact thirds, fifths and sevenths, and nothing is rounded. The lowest snorm code is -1 too.
//
// Errors: bad_option (there is no such level, or it does not have level_bytes() bytes), out_of_memory, cancelled.
[[nodiscard]] Result<Image> decode(const Texture& texture, int level, const Execution& execution = {});

// The normals of every level of a texture. unorm values become n = 2 c - 1; y is negated if it points down in the
// texture. If the swizzle holds z, vectors are normalised (shorter than 1e-6: (0, 0, 1); z below 0: as stored). If it
// holds only x and y, z = reconstruct_z(x, y); if x^2 + y^2 is above 1, x and y are divided by their length, so that
// the vector has unit length. A vector that is not finite, or whose squared length is not, becomes (0, 0, 1), or
// NaN with UnpackOptions::keep_invalid. 32-bit
// floats whose vector already has unit length (x^2 + y^2 + z^2 within 2^-20 of 1) are unchanged, so that several
// commands in a row give the same bytes as one.
//
// Floats in ValueRange::automatic are read as Texture::normal_encoding states ("signed" or "unsigned"). If it is empty,
// the base level decides for all levels. They are signed if a value of x, y or z is below 0, or if that reading is
// nearer to unit vectors by the sum of |x^2 + y^2 + z^2 - 1| (without z, of max(0, x^2 + y^2 - 1)). Otherwise they are
// unsigned.
//
// If several channels of the swizzle hold a component, it is read from the first of them.
//
// Errors: bad_option  the swizzle lacks x or y, or has one of them in a channel that the format lacks; there is no
//                     level, or one without the extent of level_extent() or level_bytes() bytes
//         out_of_memory, cancelled
// The same bytes for every number of threads, processor and compiler.
[[nodiscard]] Result<MipChain> unpack(const Texture& texture, const UnpackOptions& options = {},
                                      const Execution& execution = {});

// The normals of a picture. The swizzle names planes: R, G, B, A. In a picture with planes of other names, R, G and B
// are the planes red, green and blue, or X, Y and Z, or U and V, in any case and after the name of a layer ("N.R",
// "ViewLayer.Normal.X"). If several layers have them, it is those without a layer, or else those of the layer called
// normal. In a picture without any of these, the plane Y is used for R, G and B; without Y, the planes are R, G, B, A
// in their order. Without a swizzle in the options, x, y and z are R, G and B, or the two planes of a picture are x and
// y. ValueRange::automatic: by Image::normal_encoding, else as above. Errors: also bad_option if it is not clear which
// layer holds the normals.
[[nodiscard]] Result<NormalMap> unpack(const Image& image, const UnpackOptions& options = {},
                                       const Execution& execution = {});

}  // namespace tex
#pragma GCC visibility pop
