// SPDX-License-Identifier: Apache-2.0
// picture.h: turns pictures into textures of one level.

#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <tex/format.h>
#include <tex/types.h>

namespace tex::inline v1 {

// What a picture becomes: each plane is a channel of a texture, in the smallest format that holds the values unchanged
// (8 bits if samples have 1, 2, 4 or 8 bits, otherwise 16; half; float). If there is a plane R, the channels are R, G,
// B and A. Grey and alpha become R = G = B and A. In all other cases the channels are the planes in their order. What
// the channels hold is not known (Texture::swizzle_known).
struct PictureTexture {
    Texture head;                     // without a level
    std::vector<std::size_t> planes;  // the plane for each channel
    bool rounds = false;              // 16-bit texels hold values of another bit depth: see round_to_texels()
};

// The texture of a picture whose planes have these names, sample and bits. Errors: unsupported (no R and more than four
// planes). May throw std::bad_alloc.
[[nodiscard]] Result<PictureTexture> picture_texture_of(const std::vector<std::string>& names, SampleKind sample,
                                                        int bits);

// Writes the first `rows` rows of an image as texels of `format`; planes[c] is the plane for channel c. Values are
// clamped and rounded to the samples of the format, which are unorm or floating.
void store_texels(const Image& image, int rows, Format format, const std::vector<std::size_t>& planes, std::byte* out);

// Rounds `count` values of a picture to values that a 16-bit texel can hold.
void round_to_texels(const float* values, int count, float* out);

}  // namespace tex::inline v1
