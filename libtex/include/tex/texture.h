// SPDX-License-Identifier: Apache-2.0
// texture.h: a packed texture: the bytes of its levels and their meaning.

#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <tex/format.h>
#include <tex/normal_map.h>

#pragma GCC visibility push(default)
namespace tex {

// One level: exactly level_bytes(format, extent) bytes in the layout of the format.
struct Level {
    Extent extent;
    std::vector<std::byte> bytes;
};

// A texture between pack() and a file, or between a file and unpack(). levels[0] is the base level; the others have the
// extents of level_extent().
struct Texture {
    Format format = Format::rgba8_unorm;
    std::vector<Level> levels;

    // What the channels hold, and the direction of y. If a file does not state them, the reader leaves `swizzle_known`
    // or `y_known` false, and the value is the likeliest for the file's format. A format of one channel has it in R;
    // if that channel is alpha (DDPF_ALPHA, DXGI_FORMAT_A8_UNORM), the swizzle is 000_.
    Swizzle swizzle = kSwizzleXyz;
    bool swizzle_known = false;
    YAxis y_axis = YAxis::up;
    bool y_known = false;

    // Where R, G and B are equal and A varies, they hold x and A holds y: the convention of ASTC and KTX2 (Khronos'
    // texture tools, --normal-mode). Elsewhere such texels are DXT5nm. guess_swizzle() asks for it.
    bool x_in_grey = false;

    // As Image::normal_encoding: "signed" if floats are the components of normals themselves, or empty.
    std::string normal_encoding;

    // The file declares its colours as sRGB. That is a mistake for normals; the bytes are used as they are.
    bool srgb = false;

    // Of heights: the strengths with which bake() makes the normals again from which they were integrated. 0: not
    // known.
    float bumpiness_x = 0.0f, bumpiness_y = 0.0f;

    // The orientation that the file states, 1 to 8, as in TIFF and EXIF. The texels have been turned accordingly; the
    // vectors in them are as they are stored.
    int orientation = 1;

    // Bytes after the last level, which were not read.
    std::uint64_t trailing_bytes = 0;

    // Other faults that the reader ignored ("mip count says 3, the data end after 2"), one sentence each.
    std::vector<std::string> remarks;

    [[nodiscard]] Extent extent() const { return levels.empty() ? Extent{} : levels.front().extent; }
};

}  // namespace tex
#pragma GCC visibility pop
