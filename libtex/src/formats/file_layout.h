// SPDX-License-Identifier: Apache-2.0
// file_layout.h: the layout of a DDS or KTX2 file that is about to be written.
//
// The layout depends only on the head of a texture and is known before there are any texels. A writer may therefore
// hold the whole texture, or place the bytes of the levels one strip at a time.

#pragma once

#include <cstddef>
#include <vector>

#include <tex/format.h>

namespace tex::inline v1 {

// All of a texture except its bytes.
struct TextureHead {
    Format format = Format::rgba8_unorm;
    Extent extent;
    int levels = 1;
    Swizzle swizzle = kSwizzleXyz;
    bool swizzle_known = false;
    YAxis y_axis = YAxis::up;
    bool y_known = false;
    float bumpiness_x = 0.0f, bumpiness_y = 0.0f;
};

[[nodiscard]] TextureHead head_of(const Texture& texture);

// How texels change when they are written to a file.
enum class Rearrange {
    none,   // the bytes of the format, unchanged
    widen,  // three channels become four, A = 1
    bgr,    // red and blue of 8-bit texels are exchanged, as Direct3D 9 stores them
};

struct FileLayout {
    struct Level {
        std::size_t offset = 0;  // from the start of the file
        std::size_t bytes = 0;
    };
    std::vector<std::byte> head;  // the file's first bytes
    Rearrange rearrange = Rearrange::none;
    std::vector<Level> levels;  // [0] is the base level; all bytes between head and levels are 0
    std::size_t size = 0;       // of the whole file
};

// The format that DDS and KTX2 store: formats of three channels with 16 or 32 bits get a fourth (Rearrange::widen).
[[nodiscard]] Format widened(Format format);

// Bytes of a texel (or of a block) of `format` after `rearrange`.
[[nodiscard]] std::size_t stored_block_bytes(Format format, Rearrange rearrange);

// Bytes of a level after `rearrange`.
[[nodiscard]] std::size_t stored_level_bytes(Format format, Extent extent, Rearrange rearrange);

// Copies `texels` texels of `format` (blocks, if it is a block format) from `source` to `target`.
void rearrange_texels(Format format, Rearrange rearrange, const std::byte* source, std::size_t texels,
                      std::byte* target);

// The bytes of the whole file.
[[nodiscard]] std::vector<std::byte> assemble(const Texture& texture, const FileLayout& layout);

}  // namespace tex::inline v1
