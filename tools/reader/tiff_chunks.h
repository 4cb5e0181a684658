// SPDX-License-Identifier: Apache-2.0
// tiff_chunks.h: the strips and tiles of a TIFF file.

#pragma once

#include <tiffio.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "decoders.h"

namespace tex::reader {

// The first error of libtiff since this text was cleared.
std::string& tiff_error();

// The layout of a picture of a file.
struct TiffLayout {
    std::uint32_t width = 0, height = 0;
    std::uint16_t channels = 1, bits = 1, format = 1, photometric = 0, planar = 1, compression = 1;
    // A chunk is a tile, or a strip, which is as wide as the picture.
    bool has_tiles = false;
    std::uint32_t chunk_width = 0, chunk_height = 0;

    [[nodiscard]] bool is_planar() const { return planar == PLANARCONFIG_SEPARATE && channels > 1; }
    [[nodiscard]] bool is_palette() const { return photometric == PHOTOMETRIC_PALETTE; }
    // Whether libtiff turns the colours to RGB of 8 bits. JPEG in TIFF is turned to RGB by its own decoder.
    [[nodiscard]] bool needs_rgb() const {
        const bool is_jpeg = compression == COMPRESSION_JPEG;
        return compression == COMPRESSION_OJPEG || (photometric == PHOTOMETRIC_YCBCR && !is_jpeg) ||
               photometric == PHOTOMETRIC_CIELAB || photometric == PHOTOMETRIC_ICCLAB ||
               photometric == PHOTOMETRIC_LOGL || photometric == PHOTOMETRIC_LOGLUV;
    }
};

TiffLayout tiff_layout(TIFF* tiff);

// A chunk that was never written has no offset or no bytes. GDAL writes such files (SPARSE_OK=TRUE), and reads the
// no-data value there, or 0.
struct ChunkCount {
    std::uint32_t absent = 0, all = 0;
};
ChunkCount count_chunks(TIFF* tiff, const TiffLayout& layout);

// Reads rows of a picture, those of a row of chunks at a time.
class TiffChunks {
public:
    // The layout and the samples must outlive this object. Absent chunks hold `no_data` if a sample can have this
    // value.
    TiffChunks(TIFF* tiff, const TiffLayout& layout, const Samples& samples, std::optional<double> no_data = {});

    // Whether the sizes that libtiff gives fit the layout.
    [[nodiscard]] bool is_sound() const { return is_sound_; }

    // Reads rows [y, y + count), of a whole row of chunks. False if they are damaged.
    bool read(std::uint32_t y, std::uint32_t count, std::byte* rows);

private:
    void find_shift();
    [[nodiscard]] std::uint32_t chunk_at(std::uint32_t x, std::uint32_t y, std::uint16_t plane) const;
    bool fetch(std::uint32_t chunk, std::uint32_t count);
    void place(std::uint32_t x, int plane, std::uint32_t count, std::byte* rows) const;
    void place_colours(const std::byte* from, std::size_t columns, std::byte* to) const;
    void place_no_data(std::uint32_t x, int plane, std::uint32_t count, std::byte* rows) const;

    TIFF* tiff_;
    const TiffLayout& layout_;
    const Samples& samples_;
    std::size_t row_bytes_ = 0;
    std::vector<std::byte> chunk_;
    std::vector<std::byte> no_data_;  // a sample; empty: absent chunks hold zeros
    bool is_sound_ = false;
    std::uint16_t* palette_[3] = {};
    int palette_unit_ = 257;
};

}  // namespace tex::reader
