// SPDX-License-Identifier: Apache-2.0
// input_kind.h: what check-normals finds a picture to be, for the commands that were given it as something else. All
// commands thus call a picture by one name.

#pragma once

#include <optional>
#include <string>

#include <tex/file.h>
#include <tex/height.h>

namespace tex::cli {

struct JudgedPicture {
    std::string words;             // of the finding that decides, with its id: "R, G and B are equal ... (N210)"
    bool is_no_map = false;        // colours, data, heights, or a map that lost x
    bool is_object_space = false;  // vectors of all directions
    bool is_inverted = false;      // blue, or the whole picture
    bool is_x_ray = false;         // x, y and z in A, B and G
    bool is_other_blue = false;    // x and y beside other data
    bool is_damaged = false;       // by a curve, levels or alpha, which repair-normals undoes
    bool is_subsampled = false;    // colours at half the resolution of lightness
    bool is_uneven = false;        // vectors of other lengths than 1
    bool has_background = false;   // normals around which a colour that is none is not filled
    std::optional<HeightChannel> height_bytes = {};  // CheckReport::height_bytes
    bool has_alpha = false;                          // data beside the normals, in alpha
    bool is_vectors = false;  // unit vectors are stored in three channels: it is a normal map by intention
};

// Reads the file again, as check-normals does, which takes as long: for pictures that raise a doubt. Nothing if it
// cannot be read twice.
[[nodiscard]] std::optional<JudgedPicture> judge_picture(const std::string& path, const ReadOptions& read);

// "this is no normal map: R, G and B are equal ..."
[[nodiscard]] std::string no_map_text(const JudgedPicture& judged);

// Whether the words name another layout in which the picture would be a normal map.
[[nodiscard]] bool names_layout(const JudgedPicture& judged);

// Added where a manifest makes nothing of such an input.
inline constexpr const char* kTakeAny = "; check = { inputs = false } in the rule makes it all the same";

// A picture of colours of which the luma would be taken for heights.
struct JudgedColours {
    std::string words = {};                     // if it is a normal map, or holds the bytes of heights; or empty
    std::optional<HeightChannel> channel = {};  // that reads such bytes
};
[[nodiscard]] JudgedColours judge_colours(const std::string& path, const ReadOptions& read);

}  // namespace tex::cli
