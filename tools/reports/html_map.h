// SPDX-License-Identifier: Apache-2.0
// html_map.h: a normal map for a page: still pictures, and its levels for the reader's GPU.

#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <tex/format.h>
#include <tex/mesh.h>
#include <tex/types.h>

#include "cli/json.h"
#include "reports/html_mesh.h"

namespace tex::cli {

// A still picture, as a PNG.
struct HtmlPicture {
    std::string caption;
    std::string alt;  // the picture in words
    Extent extent;
    std::vector<std::byte> png;
};

// The longest sides of still pictures, in pixels; 0: no such pictures.
struct HtmlSizes {
    int thumbnail = 72;
    int lit = 256;
    int view = 192;  // of the mip chain and the false colours
};

// The sizes that keep a page with `files` files small.
[[nodiscard]] HtmlSizes html_sizes(std::size_t files);

// The longest side of a level that a page may contain.
inline constexpr int kLargestHtmlLevel = 1024;

// Levels for a GPU, the largest first. Either all of them are packed as in the file, or all of them are PNGs of x, y
// (up) and z with 8 bits each.
struct HtmlLevels {
    struct One {
        Extent extent;
        std::vector<std::byte> bytes;
    };
    std::vector<One> levels;
    int first = 0;  // the file's level that is the largest one here

    // Removes levels that are longer than `side`.
    void limit(int side);
    [[nodiscard]] std::size_t bytes() const;
};

// The mesh that a map is on.
struct HtmlOnMesh {
    HtmlPicture still;
    std::shared_ptr<const HtmlMesh> mesh;  // for the reader's GPU; null if it is too large for a page
    std::size_t triangles = 0;
    YAxis y = YAxis::up;  // where green points there
    std::string map;      // as preview-normals names it, for a shell
};

// A mesh that the map is compared with, drawn beside it and turned with it.
struct HtmlBeside {
    HtmlPicture still;
    std::shared_ptr<const HtmlMesh> mesh;  // for the reader's GPU; null if it is too large for a page
    std::string remark;                    // what the page says about it
    std::vector<std::byte> missed;         // a PNG that is white where the map lacks what that mesh has; may be empty
};

struct HtmlMap {
    std::string file;
    Format format = Format::rgba8_unorm;
    Swizzle swizzle{};
    YAxis y = YAxis::up;  // as it is shown: as measured, else as the file states, else up
    Extent extent;
    int stored_levels = 0;
    MipChain chain;  // for further pictures; may be cleared

    HtmlPicture thumbnail, lit;
    std::vector<HtmlPicture> views;
    std::optional<HtmlOnMesh> on_mesh;
    std::optional<HtmlBeside> beside;
    std::vector<std::byte> occlusion;  // a grey PNG for the light that can be moved; empty: there is none
    std::string occlusion_file;        // for preview-normals
    HtmlLevels packed;                 // for block formats
    HtmlLevels decoded;                // for other formats, and if the packed levels end before they are small

    [[nodiscard]] bool without_z() const;

    // The levels that a page shows, after limit(). May be empty.
    [[nodiscard]] const HtmlLevels& shown() const;
    void limit(int side);
    // The number of characters that the map takes in a page: pictures, and the levels shown.
    [[nodiscard]] std::size_t picture_size() const;
    [[nodiscard]] std::size_t level_size() const;

    // The data that the page's script needs.
    [[nodiscard]] Json json() const;
};

// Converts a picture for a page. Errors: out_of_memory.
[[nodiscard]] Result<HtmlPicture> html_picture(const Texture& picture, std::string caption, std::string alt);

// The mesh that a map is on.
struct MapOnMesh {
    TangentSpace space;
    YAxis y = YAxis::up;     // where green of the map points there
    bool has_seams = false;  // the UVs have seams
    // For preview-normals, as a shell reads them: the options that name the mesh and its parts, and the map's name.
    std::string arguments;
    std::string map;
};

// The occlusion of a map.
struct MapOcclusion {
    const Plane<float>* plane;
    std::string file;  // where it is from
};

// Draws a texture whose channels have the meaning that `swizzle` gives, with green as `y` says; also on its mesh,
// unless that is null, and under ambient light with its occlusion, unless that is null. Errors: those of the verbs.
[[nodiscard]] Result<HtmlMap> draw_html_map(const std::string& file, const Texture& texture, const Swizzle& swizzle,
                                            YAxis y, const MapOnMesh* mesh, const HtmlSizes& sizes,
                                            const Execution& execution, const MapOcclusion* occlusion = nullptr);

}  // namespace tex::cli
