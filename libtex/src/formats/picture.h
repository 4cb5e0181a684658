// SPDX-License-Identifier: Apache-2.0
// picture.h: turns pictures into textures of one level.

#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <tex/image.h>
#include <tex/result.h>
#include <tex/texture.h>

namespace tex {

// Converts the picture's planes to the channels of a texture, in the smallest format that holds their values unchanged:
// 8 bits if samples have 1, 2, 4 or 8 bits, otherwise 16; half; float. If there is a plane R, the channels are R, G, B
// and A. Grey and alpha become R = G = B and A. In all other cases the channels are the planes in their order. What the
// channels hold is not known (Texture::swizzle_known).
//
// Errors: unsupported (no R and more than four planes). May throw std::bad_alloc.
[[nodiscard]] Result<Texture> texture_of(const Image& image);

// What texture_of() makes of a picture with planes of these names, sample and bits, as far as this can be known without
// the values.
struct PictureTexture {
    Texture head;                     // without a level
    std::vector<std::size_t> planes;  // the plane for each channel
    bool rounds = false;              // 16-bit texels hold values of another bit depth: see round_to_texels()
};
[[nodiscard]] Result<PictureTexture> picture_texture_of(const std::vector<std::string>& names, SampleKind sample,
                                                        int bits);

// Texels of `format` from these planes, one plane for each channel. Values are clamped and rounded to the samples of
// the format, which are unorm or floating. May throw std::bad_alloc.
[[nodiscard]] Level level_of(const Image& image, Format format, const std::vector<std::size_t>& planes);

// Rounds `count` values of a picture to values that a 16-bit texel can hold.
void round_to_texels(const float* values, int count, float* out);

}  // namespace tex
