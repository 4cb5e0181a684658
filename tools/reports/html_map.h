// SPDX-License-Identifier: Apache-2.0
// html_map.h: a normal map as a page shows it: still pictures, and its levels for the reader's GPU.

#pragma once

#include <string>
#include <vector>

#include <tex/execution.h>
#include <tex/mip_chain.h>
#include <tex/result.h>
#include <tex/texture.h>

#include "reports/json.h"

namespace tex::cli {

// A still picture, as a PNG.
struct HtmlPicture {
    std::string caption;
    std::string alt;  // the picture in words
    Extent extent;
    std::vector<std::byte> png;
};

// Longest sides of still pictures, in pixels; 0: no such pictures.
struct HtmlSizes {
    int thumbnail = 72;
    int lit = 256;
    int view = 192;  // of the mip chain and the false colours
};

// Sizes that keep a page of `files` files light.
[[nodiscard]] HtmlSizes html_sizes(std::size_t files);

// The longest side of a level that goes into a page.
inline constexpr int kLargestHtmlLevel = 1024;

// Levels for a GPU, the largest first: all of them packed as in the file, or all of them PNGs of x, y (up) and z with 8
// bits each.
struct HtmlLevels {
    struct One {
        Extent extent;
        std::vector<std::byte> bytes;
    };
    std::vector<One> levels;
    int first = 0;  // which level of the file the largest one is

    // Drops levels longer than `side`.
    void limit(int side);
    [[nodiscard]] std::size_t bytes() const;
};

struct HtmlMap {
    std::string file;
    Format format = Format::rgba8_unorm;
    Swizzle swizzle{};
    YAxis y = YAxis::up;  // as the file says, else up
    Extent extent;
    int stored_levels = 0;
    MipChain chain;  // for further pictures; may be cleared

    HtmlPicture thumbnail, lit;
    std::vector<HtmlPicture> views;
    HtmlLevels packed;   // of block formats
    HtmlLevels decoded;  // of all others, and where the packed levels end before they are small

    [[nodiscard]] bool without_z() const;

    // The levels that a page shows whose levels are at most `side` long; may be empty.
    [[nodiscard]] const HtmlLevels& shown() const;
    void limit(int side);
    // Characters that the map takes in a page: pictures, and the levels shown.
    [[nodiscard]] std::size_t picture_size() const;
    [[nodiscard]] std::size_t level_size() const;

    // What the page's script has to know.
    [[nodiscard]] Json json() const;
};

// A picture as a page holds it. Errors: out_of_memory.
[[nodiscard]] Result<HtmlPicture> html_picture(const Texture& picture, std::string caption, std::string alt);

// Draws a texture whose channels hold what `swizzle` says. Errors: those of the verbs.
[[nodiscard]] Result<HtmlMap> draw_html_map(const std::string& file, const Texture& texture, const Swizzle& swizzle,
                                            const HtmlSizes& sizes, const Execution& execution);

}  // namespace tex::cli
