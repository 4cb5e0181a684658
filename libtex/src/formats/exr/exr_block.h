// SPDX-License-Identifier: Apache-2.0
// exr_block.h: texels of an EXR that are compressed apart from all others.

#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include <tex/types.h>

#include "formats/exr/exr_zip.h"
#include "formats/row_target.h"
#include "threads/pool.h"

namespace tex::inline v1 {

inline constexpr int kExrTile = 64;  // the sides of a tile, in texels

// How a level is divided: its rows into bands, a band into chunks (groups of scan lines, or tiles), and these among
// blocks. This depends on the picture alone, so the bytes of the file do too.
struct ExrGrid {
    int channels;
    std::size_t channel_bytes;  // of a value: 2 or 4
    Extent extent;              // of the level
    int level;
    bool has_tiles;

    [[nodiscard]] std::size_t texel_bytes() const { return static_cast<std::size_t>(channels) * channel_bytes; }
    [[nodiscard]] std::size_t row_bytes() const { return static_cast<std::size_t>(extent.width) * texel_bytes(); }
    // Rows of a band, which are those of its chunks; the last band may have fewer.
    [[nodiscard]] int band_rows() const;
    [[nodiscard]] int bands() const;
    // Texels; the last chunk of a band may be narrower.
    [[nodiscard]] int chunk_width() const { return has_tiles ? std::min(kExrTile, extent.width) : extent.width; }
    [[nodiscard]] int chunks_of_band() const;
    // The last block of a band may have fewer.
    [[nodiscard]] int chunks_of_block() const;
};

// The rows of a band, with interleaved channels. Blocks share them.
struct ExrBand {
    int index = 0;  // in the level
    int rows = 0;
    int held = 0;  // rows that have been added
    std::vector<std::byte> texels;

    // Empties the band, which becomes band `index` of the level. Throws std::bad_alloc.
    void begin(const ExrGrid& grid, int its_index);
    // Adds rows until the band is full. Returns how many it took.
    int add(const ExrGrid& grid, const std::byte* from, int count);
    [[nodiscard]] bool is_full() const { return held == rows; }
};

// What a block puts into the file.
struct ExrChunks {
    std::vector<std::byte> bytes;
    std::vector<std::size_t> sizes;  // of each chunk
};

// Some chunks of a band.
class ExrBlock final : public RowWork {
public:
    // Chunks [begin, end) of a full band. `number` is that of the block in the file.
    ExrBlock(const ExrGrid& grid, std::shared_ptr<const ExrBand> band, int begin, int end, int number,
             Pool<Zipper> zippers)
        : grid_(grid), band_(std::move(band)), begin_(begin), end_(end), number_(number), zippers_(std::move(zippers)) {
    }

    Result<void> run() override;

    [[nodiscard]] int number() const { return number_; }
    // Takes what run() has made.
    [[nodiscard]] ExrChunks take_chunks() { return std::move(chunks_); }

private:
    void append_chunk(int chunk, Zipper& zipper);

    const ExrGrid grid_;
    std::shared_ptr<const ExrBand> band_;  // until run() has ended
    const int begin_, end_, number_;
    Pool<Zipper> zippers_;
    ExrChunks chunks_;
};

}  // namespace tex::inline v1
