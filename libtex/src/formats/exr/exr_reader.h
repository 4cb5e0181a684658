// SPDX-License-Identifier: Apache-2.0
// exr_reader.h: reads rows of texels of one part of an EXR file. OpenEXR reads the header; the table of chunks and the
// chunks themselves are read here, so that several threads can read at once and every claim is checked.

#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <ImfHeader.h>

#include <tex/types.h>

#include "files/input_file.h"
#include "formats/exr/exr_chunk.h"
#include "formats/exr/exr_part.h"
#include "threads/pool.h"

namespace tex::inline v1 {

// Where the texels of some rows go. A row holds all values of one channel, each as in the file, then those of the next
// channel.
struct ExrPlane {
    ExrChannel channel;
    std::size_t offset = 0;  // of the channel in a row, in bytes
};

struct ExrTarget {
    std::span<const ExrPlane> planes;
    std::byte* rows = nullptr;
    std::size_t row_bytes = 0;
};

class ExrReader {
public:
    // Reads the table of chunks of part `part`. Throws std::bad_alloc. Errors: bad_data, io. Preconditions: the header
    // has been checked, because it determines how much memory is allocated; is_decoded_here(its compression).
    static Result<std::shared_ptr<ExrReader>> open(const InputFile& file, const ExrHeaders& headers, int part);
    // Opens a file of one part, which the reader keeps.
    static Result<std::shared_ptr<ExrReader>> open(InputFile file, const ExrHeaders& headers);

    [[nodiscard]] const Imf::Header& header() const { return header_; }
    [[nodiscard]] Extent extent(int level) const { return levels_[static_cast<std::size_t>(level)].extent; }
    // The rows of a chunk.
    [[nodiscard]] int rows_together(int level) const;

    // Reads rows [first, first + count) of a level that the file has (of ripmaps, only level 0). Any thread may call
    // this. Throws std::bad_alloc. Errors: bad_data, io.
    Result<void> read(int level, int first, int count, const ExrTarget& target);

private:
    // The chunks of a level: tiles, or groups of scan lines over the whole width.
    struct Level {
        Extent extent;
        Extent chunk;           // of a chunk from which nothing is cut off
        int across = 1;         // chunks side by side
        std::size_t first = 0;  // of its chunks in the table
        [[nodiscard]] Extent chunk_extent(int i, int j) const;
    };

    ExrReader(const Imf::Header& header, std::optional<std::int32_t> part) : header_(header), part_(part) {}
    void find_levels();
    [[nodiscard]] Error damaged(const char* reason) const;
    Result<void> read_table(std::uint64_t place);
    // Reads chunk (i, j) of a level to decoder.bytes.
    Result<void> read_chunk(int level, int i, int j, ChunkDecoder& decoder) const;
    void store(const std::byte* texels, Extent extent, int left, int top, int count, const ExrTarget& target) const;

    Imf::Header header_;
    std::optional<std::int32_t> part_;  // the number that begins each chunk in a file of several parts
    std::optional<InputFile> kept_;
    const InputFile* file_ = nullptr;
    bool has_tiles_ = false;
    std::size_t texel_bytes_ = 0;  // over all channels
    std::vector<Level> levels_;
    std::size_t chunks_ = 0;            // of all levels
    std::vector<std::uint64_t> table_;  // where each chunk begins
    Pool<ChunkDecoder> decoders_;
};

}  // namespace tex::inline v1
