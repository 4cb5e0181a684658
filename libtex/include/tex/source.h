// SPDX-License-Identifier: Apache-2.0
// source.h: normals from files: what a file says of its layout, what the caller says, and what the texels show.

#pragma once

#include <optional>
#include <string>
#include <vector>

#include <tex/execution.h>
#include <tex/image_io.h>
#include <tex/mip_chain.h>
#include <tex/result.h>
#include <tex/swizzle.h>
#include <tex/texture.h>
#include <tex/unpack.h>

#pragma GCC visibility push(default)
namespace tex {

struct SourceOptions {
    ReadOptions read;

    // As for unpack(). Without a swizzle the file's own counts, and where it has none guess_swizzle().
    UnpackOptions unpack;

    std::optional<Swizzle> bc5_swizzle;  // of BC5 files, instead of their own; unpack.swizzle counts before it
    bool r_or_a = false;        // x is in A where guess_swizzle() finds it there, else in R, and y in G; unpack.swizzle
                                // counts before it
    bool file_y_first = false;  // what a file says of y counts before unpack.y_axis
};

// What a file turned out to hold.
struct SourceInfo {
    Format format = Format::rgba8_unorm;
    Swizzle swizzle = {};      // that it was read with
    bool guessed = false;      // the texels told the swizzle, and it is not simply rgb in a file that looks like rgb
    YAxis y_axis = YAxis::up;  // that it was read with: where y points in the file
    bool srgb = false;         // as these two in Texture
    std::vector<std::string> remarks;
};

struct Source {
    MipChain chain;  // y up, as always
    SourceInfo info;
};

// Reads the normals in a file: read_texture(), guess_swizzle() where it is needed, unpack(). With `base_only` the
// smaller levels are left out.
//
// Errors, all of which name the file: those of the three; unsupported where there is one channel only.
[[nodiscard]] Result<Source> read_normals(const std::string& path, const SourceOptions& options = {},
                                          bool base_only = false, const Execution& execution = {});

}  // namespace tex
#pragma GCC visibility pop
