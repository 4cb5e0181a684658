// SPDX-License-Identifier: Apache-2.0
// picture.h: pictures as textures of one level.

#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <tex/image.h>
#include <tex/result.h>
#include <tex/texture.h>

namespace tex {

// The picture's planes as the channels of a texture, in the smallest format that holds their values as they are: 8 bits
// where samples have 1, 2, 4 or 8, else 16; half; float. Planes R, G, B and A where there is an R; grey and alpha as R
// = G = B and A; else the planes in their order. What the channels hold is not known (Texture::swizzle_known).
//
// Errors: unsupported (no R and more than four planes). May throw std::bad_alloc.
[[nodiscard]] Result<Texture> texture_of(const Image& image);

// What texture_of() makes of a picture with planes of these names, sample and bits, as far as that is known without its
// values.
struct PictureTexture {
    Texture head;                     // without a level
    std::vector<std::size_t> planes;  // of the channels
    bool rounds = false;              // texels of 16 bits hold values of another depth: see round_to_texels()
};
[[nodiscard]] Result<PictureTexture> picture_texture_of(const std::vector<std::string>& names, SampleKind sample,
                                                        int bits);

// Texels of `format` from these planes, one for each channel; values are clamped and rounded to its samples, which are
// unorm or floating. May throw std::bad_alloc.
[[nodiscard]] Level level_of(const Image& image, Format format, const std::vector<std::size_t>& planes);

// `count` values of a picture become those that a texel of 16 bits holds.
void round_to_texels(const float* values, int count, float* out);

}  // namespace tex
