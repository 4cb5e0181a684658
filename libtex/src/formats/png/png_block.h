// SPDX-License-Identifier: Apache-2.0
// png_block.h: rows of a PNG that are filtered and compressed apart from all others.

#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "formats/row_target.h"
#include "threads/pool.h"

struct z_stream_s;

namespace tex::inline v1 {

// How rows are divided among blocks. This depends on the picture alone, so the bytes of the file do too.
struct PngShape {
    std::size_t row_bytes;
    std::size_t texel_bytes;
    int height;
    bool swaps;  // 16 bits: levels are little-endian, PNG is big-endian

    [[nodiscard]] int rows_of_block() const;
};

// The state of a compressor. It takes longer to make than to use again.
class PngDeflater {
public:
    // Throws std::bad_alloc.
    PngDeflater();
    ~PngDeflater();
    PngDeflater(const PngDeflater&) = delete;
    PngDeflater& operator=(const PngDeflater&) = delete;

    // The most bytes that a block of `count` bytes can become.
    [[nodiscard]] std::size_t bound(std::size_t count) const;

    // Begins a block, whose compressed bytes go to `out`, where there is room for all.
    void begin(std::uint8_t* out, std::size_t room);
    // Takes bytes, less than 2^32. False if there is not enough room.
    [[nodiscard]] bool put(const std::uint8_t* bytes, std::size_t count);
    // Ends the block at the boundary of a byte, and the stream if the block is the last. Returns the number of bytes in
    // `out`, or 0 if there is not enough room.
    [[nodiscard]] std::size_t end(bool is_last);

    std::vector<std::uint8_t> row;  // room for a filtered row

private:
    const std::unique_ptr<z_stream_s> stream_;
};

// All blocks together are one zlib stream.
class PngBlock final : public RowWork {
public:
    PngBlock(const PngShape& shape, Pool<PngDeflater>& deflaters);

    // Empties the block, for the rows from row `first`. `before` is the row before them, or null.
    void begin(int first, const std::byte* before);
    // Adds rows until the block is full. Returns how many it took.
    int add(const std::byte* rows, int count);
    [[nodiscard]] bool is_full() const { return held_ == rows_; }
    [[nodiscard]] bool is_last() const { return first_ + rows_ == shape_.height; }
    [[nodiscard]] int first() const { return first_; }
    [[nodiscard]] int next() const { return first_ + rows_; }

    // Filters and compresses a full block.
    Result<void> run() override;

    // Appends the block to `file` as an IDAT chunk. `adler`, the check value of the rows before (1 at first), becomes
    // that of all rows up to the end of the block; the last block contains it.
    void append_to(std::vector<std::byte>& file, std::uint32_t& adler) const;

private:
    // Row -1 is the row before the block.
    [[nodiscard]] std::uint8_t* row(int j) { return held_rows_.data() + static_cast<std::size_t>(j + 2) * stride_; }

    const PngShape shape_;
    const std::size_t stride_;  // from row to row: there are zeros before each row, as filter_png_row() requires
    Pool<PngDeflater>& deflaters_;
    std::vector<std::uint8_t> held_rows_;
    int first_ = 0;
    int rows_ = 0;  // of the full block
    int held_ = 0;
    std::unique_ptr<std::uint8_t[]> packed_;  // what run() has made
    std::size_t room_ = 0;
    std::size_t packed_bytes_ = 0;
    std::uint32_t adler_ = 1;  // of the filtered rows
};

}  // namespace tex::inline v1
