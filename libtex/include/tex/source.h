// SPDX-License-Identifier: Apache-2.0
// source.h: normals from files. The layout comes from the caller, from the file, or from the texels.

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

    // As for unpack(). Without a swizzle the file's own is used, or guess_swizzle() if the file has none.
    UnpackOptions unpack;

    std::optional<Swizzle> bc5_swizzle;  // of BC5 files, instead of their own; unpack.swizzle takes precedence
    bool r_or_a = false;           // y is in G, and x in A if guess_swizzle() finds it there, else in R; unpack.swizzle
                                   // takes precedence
    bool doubt_y = false;          // if neither the file nor the caller states y, measure it: SourceInfo::y_doubtful
    bool inspect = false;          // look for signs that the texels hold something else: object_space, background,
                                   // others
    bool drop_others = false;      // channels that hold no part of the normals are not carried along: see SourceInfo
    bool fill_background = false;  // black, grey or white around charts takes the nearest normals; smaller levels are
                                   // left out, and the base level is held in memory
    bool measure_y = false;     // the texels of the base level decide about y, whatever the file or unpack.y_axis state
    bool file_y_first = false;  // the direction that a file states takes precedence over unpack.y_axis

    friend bool operator==(const SourceOptions&, const SourceOptions&) = default;
};

// A channel of a file that holds other data beside the normals: heights, gloss, a mask.
struct OtherChannel {
    char name = 'A';                      // R, G, B, A, or L: the lengths of vectors
    float least = 0.0f, greatest = 0.0f;  // as decode() gives its values

    friend bool operator==(const OtherChannel&, const OtherChannel&) = default;
};

// What a file holds.
struct SourceInfo {
    Format format = Format::rgba8_unorm;
    Swizzle swizzle = {};      // with which it was read
    bool guessed = false;      // the swizzle comes from the texels, and is not merely rgb in a file that looks like rgb
    YAxis y_axis = YAxis::up;  // with which it was read: the direction of y in the file
    bool y_known = false;      // y_axis comes from the file, the caller or the texels; otherwise it is assumed
    bool y_doubtful = false;   // it is assumed, and the texels clearly show the other direction
    bool object_space = false;  // more than 5 % of the texels that were inspected point away from the surface
    bool z_doubtful = false;    // z is stored, but does not follow x and y: other data may be in its place
    double background = 0.0;    // the share of those that are black, grey or white, if it is 1 % or more
    // Channels of the base level, whose values differ by more than 1.5 of 255 and repeat none of x, y and z. After
    // pack_file() and blend_file(): those of them that are not in every output. Encodings with four channels take alpha
    // along (can_hold()).
    std::vector<OtherChannel> others;
    bool srgb = false;  // this and remarks: as in Texture
    std::vector<std::string> remarks;
};

struct Source {
    MipChain chain;  // y up, as always
    SourceInfo info;
};

// Reads the normals in a file by read_texture(), guess_swizzle() if it is needed, and unpack(). With `base_only` the
// smaller levels are left out.
//
// Errors, all of which name the file: those of the three functions; unsupported if there is only one channel; bad_data
// if y is to be measured and the texels do not show it clearly.
[[nodiscard]] Result<Source> read_normals(const std::string& path, const SourceOptions& options = {},
                                          bool base_only = false, const Execution& execution = {});

}  // namespace tex
#pragma GCC visibility pop
