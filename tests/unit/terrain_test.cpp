// SPDX-License-Identifier: Apache-2.0
// Tiles of a terrain that are baked one by one have the bytes of the bake of the whole.

#include "stream/terrain_rows.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <tex/file.h>
#include <tex/format.h>
#include <tex/pipeline.h>

#include "scratch.h"

namespace tex {
namespace {

struct Grid {
    std::vector<int> widths, heights;  // of the columns and the rows of tiles
    bool shared = false;

    [[nodiscard]] int columns() const { return static_cast<int>(widths.size()); }
    [[nodiscard]] int rows() const { return static_cast<int>(heights.size()); }
    // The first texel of a column or row of tiles.
    [[nodiscard]] int first(const std::vector<int>& sides, int k) const {
        int at = 0;
        for (int n = 0; n < k; ++n) at += sides[static_cast<std::size_t>(n)] - (shared ? 1 : 0);
        return at;
    }
    [[nodiscard]] Extent tile(int x, int y) const {
        return {widths[static_cast<std::size_t>(x)], heights[static_cast<std::size_t>(y)]};
    }
    [[nodiscard]] Extent whole() const {
        return {first(widths, columns()) + (shared ? 1 : 0), first(heights, rows()) + (shared ? 1 : 0)};
    }
};

class Terrain : public testing::Test, protected Scratch {
protected:
    [[nodiscard]] std::string tile_path(int x, int y) const {
        return path("tile_" + std::to_string(x) + "_" + std::to_string(y) + extension_);
    }

    // Bumps with noise in 16 bits.
    static std::vector<std::uint16_t> heights_of(Extent extent) {
        std::mt19937 random(5);
        std::vector<std::uint16_t> heights;
        for (std::int64_t k = 0; k < extent.texels(); ++k) heights.push_back(static_cast<std::uint16_t>(random()));
        return heights;
    }

    void write_part(const std::string& name, Extent whole, int left, int top, Extent part) const {
        const std::vector<std::uint16_t> heights = heights_of(whole);
        Texture texture;
        texture.format = Format::r16_unorm;
        Level level{part, std::vector<std::byte>(level_bytes(texture.format, part))};
        for (int j = 0; j < part.height; ++j) {
            for (int i = 0; i < part.width; ++i) {
                // Beyond the whole, a terrain that repeats begins again.
                const int row = (top + j) % whole.height, column = (left + i) % whole.width;
                std::memcpy(
                    level.bytes.data() + 2 * (static_cast<std::size_t>(j) * static_cast<std::size_t>(part.width) +
                                              static_cast<std::size_t>(i)),
                    &heights[static_cast<std::size_t>(row) * static_cast<std::size_t>(whole.width) +
                             static_cast<std::size_t>(column)],
                    2);
            }
        }
        texture.levels.push_back(std::move(level));
        const auto written = write_texture(name, texture);
        ASSERT_TRUE(written) << written.error().message();
    }

    // The normals in a file of floats.
    static Image normals(const std::string& input, const BakeFileOptions& options, Container container,
                         const std::string& output) {
        const auto baked = bake_file(input, output, container, options, {2, {}});
        EXPECT_TRUE(baked) << baked.error().message();
        auto image = read_image(output);
        EXPECT_TRUE(image);
        return image ? std::move(*image) : Image();
    }

    static BakeFileOptions options_with(const BakeOptions& bake, Wrap wrap, float blur) {
        BakeFileOptions options;
        options.bake = bake;
        options.heights.blur_sigma = blur;
        options.heights.wrap_x = options.heights.wrap_y = wrap;
        options.pack.encoding = Encoding::float_;
        options.strength = [](Extent) { return Strength{7.5f, 7.5f}; };
        options.mip.levels = 1;
        return options;
    }

    // What a command would find.
    [[nodiscard]] TerrainTile tile_at(const Grid& grid, int x, int y, Wrap wrap) const {
        TerrainTile tile;
        tile.shared_border = grid.shared;
        tile.neighbour = [this, &grid, x, y, wrap](int right, int down) -> std::string {
            int column = x + right, row = y + down;
            if (wrap == Wrap::repeat) {
                column = (column + grid.columns()) % grid.columns();
                row = (row + grid.rows()) % grid.rows();
            }
            if (column < 0 || row < 0 || column >= grid.columns() || row >= grid.rows()) return {};
            return std::filesystem::exists(tile_path(column, row)) ? tile_path(column, row) : "";
        };
        return tile;
    }

    // Compares texels [left, right) x [top, bottom) of a tile with those of a picture, in which the tile begins at
    // (x, y).
    static void expect_same(const Image& tile, int left, int top, int right, int bottom, const Image& whole, int x,
                            int y, const std::string& what) {
        ASSERT_EQ(tile.planes.size(), 3u) << what;
        for (std::size_t c = 0; c < 3; ++c) {
            for (int j = top; j < bottom; ++j)
                ASSERT_EQ(std::memcmp(tile.planes[c].row(j) + left, whole.planes[c].row(y + j) + x + left,
                                      static_cast<std::size_t>(right - left) * sizeof(float)),
                          0)
                    << what << " row " << j << " channel " << c;
        }
    }

    void compare(const Grid& grid, const BakeOptions& bake, Wrap wrap, float blur, Container container) {
        // A terrain that repeats and shares borders has its last row and column in common with the first ones.
        Extent whole = grid.whole();
        if (grid.shared && wrap == Wrap::repeat) whole = {whole.width - 1, whole.height - 1};
        write_part(path("whole.png"), whole, 0, 0, whole);
        for (int y = 0; y < grid.rows(); ++y) {
            for (int x = 0; x < grid.columns(); ++x)
                write_part(tile_path(x, y), whole, grid.first(grid.widths, x), grid.first(grid.heights, y),
                           grid.tile(x, y));
        }
        BakeFileOptions options = options_with(bake, wrap, blur);
        const Image expected = normals(path("whole.png"), options, container, path("whole_n.exr"));
        for (int y = 0; y < grid.rows(); ++y) {
            for (int x = 0; x < grid.columns(); ++x) {
                options.tile = tile_at(grid, x, y, wrap);
                const Image tile = normals(tile_path(x, y), options, container, path("n.exr"));
                const int left = grid.first(grid.widths, x), top = grid.first(grid.heights, y);
                const Extent extent = grid.tile(x, y);
                ASSERT_EQ(tile.extent(), extent);
                expect_same(tile, 0, 0, std::min(extent.width, whole.width - left),
                            std::min(extent.height, whole.height - top), expected, left, top,
                            "tile " + std::to_string(x) + "," + std::to_string(y));
            }
        }
    }

    std::string extension_ = ".png";
};

TEST_F(Terrain, EveryKernelAndBorderHasTheBytesOfTheWhole) {
    const Grid apart{{20, 33, 17}, {16, 21, 30}, false}, shared{{17, 33, 17}, {33, 17, 20}, true};
    for (const auto& kernel : kGradientKernelNames) {
        for (const Wrap wrap : {Wrap::clamp, Wrap::mirror, Wrap::repeat}) {
            SCOPED_TRACE(std::string(kernel.name) + " " + std::string(name_of(kWrapNames, wrap)));
            compare(apart, {kernel.value, 1.5f}, wrap, 0.0f, Container::exr);
            compare(shared, {kernel.value, 1.5f}, wrap, 0.0f, Container::exr);
        }
    }
}

TEST_F(Terrain, BlurredHeightsHaveTheBytesOfTheWhole) {
    const Grid grid{{40, 24, 33}, {24, 40, 25}, false};
    for (const Wrap wrap : {Wrap::clamp, Wrap::mirror, Wrap::repeat}) {
        SCOPED_TRACE(name_of(kWrapNames, wrap));
        compare(grid, {GradientKernel::scharr, 1.0f}, wrap, 2.0f, Container::exr);
    }
}

TEST_F(Terrain, OneRowOrColumnOfTilesIsATerrainToo) {
    for (const Wrap wrap : {Wrap::clamp, Wrap::repeat}) {
        compare({{9, 12}, {11}, false}, {GradientKernel::sobel, 1.0f}, wrap, 0.0f, Container::exr);
        compare({{9}, {12, 11}, true}, {GradientKernel::sobel, 1.0f}, wrap, 0.0f, Container::exr);
    }
}

TEST_F(Terrain, AMissingTileIsABorder) {
    const Grid grid{{20, 20, 20}, {18, 18, 18}, false};
    const Extent whole = grid.whole();
    write_part(path("whole.png"), whole, 0, 0, whole);
    write_part(path("left.png"), whole, 0, 0, {40, 54});  // without the last column of tiles
    write_part(path("top.png"), whole, 0, 0, {60, 36});   // without the last row
    for (int y = 0; y < 3; ++y) {
        for (int x = 0; x < 3; ++x) write_part(tile_path(x, y), whole, 20 * x, 18 * y, grid.tile(x, y));
    }
    std::filesystem::remove(tile_path(2, 2));
    constexpr int kReach = 4;
    BakeFileOptions options = options_with({GradientKernel::gaussian, 1.0f}, Wrap::mirror, 0.0f);
    ASSERT_LE(gradient_of(options.bake).radius, kReach);
    const auto baked = [&](const std::string& name) {
        options.tile.reset();
        return normals(path(name), options, Container::exr, path("n.exr"));
    };
    const Image all = baked("whole.png"), left = baked("left.png"), top = baked("top.png");
    for (int y = 0; y < 3; ++y) {
        for (int x = 0; x < 3; ++x) {
            if (x == 2 && y == 2) continue;
            options.tile = tile_at(grid, x, y, Wrap::mirror);
            const Image tile = normals(tile_path(x, y), options, Container::exr, path("n.exr"));
            const bool is_beside = x == 1 && y == 2, is_above = x == 2 && y == 1, is_diagonal = x == 1 && y == 1;
            // The corner beside the missing tile continues the heights of the tile below.
            const int rows = is_diagonal ? 18 - kReach : 18;
            expect_same(tile, 0, 0, 20, rows,
                        is_beside  ? left
                        : is_above ? top
                                   : all,
                        20 * x, 18 * y, "tile " + std::to_string(x) + "," + std::to_string(y));
            if (is_diagonal) expect_same(tile, 0, rows, 20 - kReach, 18, all, 20, 18, "the middle");
        }
    }
}

TEST_F(Terrain, SidesOfAPowerOfTwoAndOneShareTheirBorders) {
    write_part(tile_path(0, 0), {33, 17}, 0, 0, {17, 17});
    write_part(tile_path(1, 0), {33, 17}, 16, 0, {17, 17});
    const Grid grid{{17, 17}, {17}, true};
    BakeFileOptions options = options_with({}, Wrap::clamp, 0.0f);
    options.tile = tile_at(grid, 0, 0, Wrap::clamp);
    const Image shared = normals(tile_path(0, 0), options, Container::exr, path("n.exr"));
    options.tile->shared_border.reset();
    const Image found = normals(tile_path(0, 0), options, Container::exr, path("n.exr"));
    expect_same(found, 0, 0, 17, 17, shared, 0, 0, "found");
    // Tiles that do not share them after all.
    write_part(tile_path(1, 0), {33, 17}, 15, 0, {17, 17});
    const auto wrong = bake_file(tile_path(0, 0), path("n.exr"), Container::exr, options);
    ASSERT_TRUE(wrong) << wrong.error().message();
    EXPECT_EQ(wrong->heights.remark,
              "17 heights of the border are not those of the tile beside it, although the tiles share their borders");
}

TEST_F(Terrain, RefusesTilesThatDoNotFit) {
    const Grid grid{{20, 20}, {18}, false};
    write_part(tile_path(0, 0), {40, 18}, 0, 0, {20, 18});
    write_part(tile_path(1, 0), {40, 18}, 20, 0, {20, 17});
    BakeFileOptions options = options_with({}, Wrap::clamp, 0.0f);
    options.tile = tile_at(grid, 0, 0, Wrap::clamp);
    const auto other = bake_file(tile_path(0, 0), path("n.exr"), Container::exr, options);
    ASSERT_FALSE(other);
    EXPECT_EQ(other.error().file, tile_path(1, 0));
    EXPECT_EQ(other.error().reason, "has 20x17 texels, which do not fit beside " + tile_path(0, 0) + " with 20x18");
    write_part(tile_path(1, 0), {40, 18}, 20, 0, {20, 18});
    options.heights.blur_sigma = 9.0f;
    const auto small = bake_file(tile_path(0, 0), path("n.exr"), Container::exr, options);
    ASSERT_FALSE(small);
    EXPECT_NE(small.error().reason.find("is too small for its terrain"), std::string::npos) << small.error().reason;
    options.heights.blur_sigma = 0.0f;
    options.auto_strength = true;
    EXPECT_EQ(bake_file(tile_path(0, 0), path("n.exr"), Container::exr, options).error().code, ErrorCode::bad_option);
    options.auto_strength = false;
    options.heights.deband = Deband::on;
    EXPECT_EQ(bake_file(tile_path(0, 0), path("n.exr"), Container::exr, options).error().code, ErrorCode::bad_option);
    options.heights.deband = Deband::off;
    std::filesystem::resize_file(tile_path(1, 0), 300);
    const auto cut = bake_file(tile_path(0, 0), path("n.exr"), Container::exr, options);
    ASSERT_FALSE(cut);
    EXPECT_EQ(cut.error().file, tile_path(1, 0));
}

TEST_F(Terrain, InvalidHeightsAreCountedInTheTileAndFilledFromTheWindow) {
    extension_ = ".asc";
    const auto write_grid = [&](int x, const std::string& heights) {
        std::FILE* const file = std::fopen(tile_path(x, 0).c_str(), "w");
        ASSERT_NE(file, nullptr);
        std::fputs(("ncols 4 nrows 3 cellsize 1 " + heights).c_str(), file);
        std::fclose(file);
    };
    const Grid grid{{4, 4}, {3}, false};
    BakeFileOptions options = options_with({}, Wrap::clamp, 0.0f);
    options.tile = tile_at(grid, 0, 0, Wrap::clamp);
    write_grid(0, "1 2 3 4 1 2 -9999 4 1 2 3 4");
    write_grid(1, "5 6 7 8 5 6 7 8 5 6 7 8");
    const auto own = bake_file(tile_path(0, 0), path("n.exr"), Container::exr, options);
    ASSERT_FALSE(own);
    EXPECT_EQ(own.error().file, tile_path(0, 0));
    EXPECT_EQ(own.error().reason, "1 height is NaN, infinite or no-data, the first at column 2, row 1");
    options.heights.fill_invalid = true;
    const auto filled = bake_file(tile_path(0, 0), path("n.exr"), Container::exr, options);
    ASSERT_TRUE(filled) << filled.error().message();
    EXPECT_EQ(filled->heights.invalid_texels, 1);
    options.heights.fill_invalid = false;
    write_grid(0, "1 2 3 4 1 2 3 4 1 2 3 4");
    write_grid(1, "5 6 7 8 -9999 6 7 8 5 6 7 8");
    const auto theirs = bake_file(tile_path(0, 0), path("n.exr"), Container::exr, options);
    ASSERT_FALSE(theirs);
    EXPECT_EQ(theirs.error().file, tile_path(1, 0));
    write_grid(1, "5 6 7 8 5 6 7 -9999 5 6 7 8");  // out of reach
    EXPECT_TRUE(bake_file(tile_path(0, 0), path("n.exr"), Container::exr, options));
}

}  // namespace
}  // namespace tex
