// SPDX-License-Identifier: Apache-2.0
// terrain_rows.h: a tile of a terrain together with the border of the tiles around it, as one picture of heights.

#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include <tex/pipeline.h>

#include "files/input_file.h"
#include "formats/row_source.h"
#include "stream/tile_reader.h"

namespace tex::inline v1 {

// What a window holds of tiles that are narrower than what it wants of them.
enum class TerrainMargin {
    whole,        // nothing: they are too small for the terrain, which is an error
    where_there,  // as much as there is
};

// The rows of the window, in their order: one channel, Y, floats that were cleaned as take_heights() does. Three tiles
// are open at a time. The fields of `file` and `options` must outlive it.
class TerrainRows final : public RowSource {
public:
    // `reach`: the number of rows and columns around it on which a normal depends. May throw std::bad_alloc. Errors:
    // those of opening the tiles; bad_data (a neighbour has another height or width than the tile, or fewer rows or
    // columns than `reach`, unless it takes what is there).
    static Result<std::unique_ptr<TerrainRows>> open(InputFile& file, const BakeFileOptions& options, int reach,
                                                     TerrainMargin margin = TerrainMargin::whole);

    [[nodiscard]] const TerrainWindow& window() const { return window_; }
    // What was found in the tile itself, so far.
    [[nodiscard]] const HeightCounts& counts() const { return counts_; }
    // The tile's own picture. Only before the first row.
    [[nodiscard]] const Heights& heights() const { return center_->heights(); }
    // What to say about the tile, when its rows have been read.
    [[nodiscard]] std::string remark() const;

    Result<void> decode(int first, int count, std::byte* rows) override;
    Result<void> finish() override;
    void store(const std::byte* rows, int first, int end, Image& image) const override;

private:
    // The tiles of a band of rows, from the left; those that do not exist are null.
    using Band = std::array<std::unique_ptr<TileReader>, 3>;

    TerrainRows(InputFile& file, const BakeFileOptions& options) : file_(file), options_(options) {}
    // The path of a neighbour; empty if there is none.
    [[nodiscard]] std::string path_of(int right, int down) const;
    // How many rows or columns of the neighbour are in the window: none if it does not exist. Checks the neighbour.
    Result<int> margin(int right, int down, int reach);
    // Notes that a neighbour's texels are not as large as those of the tile.
    void compare_ground(const TileReader& tile);
    Result<void> measure(int reach);
    Result<void> enter_band(int down);
    Result<void> make_row(int j, float* out);
    Result<void> read_center(int down, int row, float* out);
    Result<void> read_side(int right, int row, const float* center, int center_width, float* out);

    InputFile& file_;
    const BakeFileOptions& options_;
    TerrainMargin takes_ = TerrainMargin::whole;
    TerrainWindow window_;
    std::unique_ptr<TileReader> center_;  // until its band is reached; only its description is used then
    static constexpr int kNoBand = -2;
    Band band_;
    int down_ = kNoBand;
    int shared_ = 0;  // rows and columns that neighbours have in common
    std::vector<float> row_, side_;
    HeightCounts counts_;
    int first_invalid_[2] = {};  // column, row; of the tile
    HeightSource center_source_;
    HeightOptions center_options_;  // with the no-data value of the tile
    std::string center_remark_, ground_remark_;
    std::int64_t disagreeing_ = 0;   // heights of shared columns
    std::string invalid_neighbour_;  // the first one with an invalid height in the window
};

}  // namespace tex::inline v1
