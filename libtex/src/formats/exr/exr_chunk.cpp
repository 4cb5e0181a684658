// SPDX-License-Identifier: Apache-2.0

#include "formats/exr/exr_chunk.h"

#include "kernels/zip_bytes.h"

namespace tex::inline v1 {

bool is_decoded_here(Imf::Compression compression) {
    switch (compression) {
        case Imf::NO_COMPRESSION:
        case Imf::RLE_COMPRESSION:
        case Imf::ZIPS_COMPRESSION:
        case Imf::ZIP_COMPRESSION: return true;
        default: return false;
    }
}

int chunk_lines(Imf::Compression compression) { return compression == Imf::ZIP_COMPRESSION ? 16 : 1; }

std::span<const std::byte> ChunkDecoder::texels(Imf::Compression compression, std::span<const std::byte> chunk,
                                                std::size_t wanted, std::size_t most) {
    if (chunk.size() >= wanted) return chunk.first(wanted);  // stored uncompressed, if compression does not help
    switch (compression) {
        case Imf::NO_COMPRESSION: return {};
        case Imf::RLE_COMPRESSION: return unrolled(chunk, wanted, most);
        default: return unzipper_.texels(chunk, wanted, most);
    }
}

// Runs: a byte n from 0 to 127 repeats the next byte n + 1 times; a byte -n from -1 to -128 precedes n bytes that are
// copied. The result is coded as before deflation in ZIP.
std::span<const std::byte> ChunkDecoder::unrolled(std::span<const std::byte> chunk, std::size_t wanted,
                                                  std::size_t most) {
    runs_.clear();
    runs_.reserve(most);
    while (chunk.size() > 1) {
        const int n = static_cast<signed char>(chunk[0]);
        const auto count = static_cast<std::size_t>(n < 0 ? -n : n + 1);
        const std::size_t taken = n < 0 ? count : 1;
        chunk = chunk.subspan(1);
        if (taken > chunk.size() || count > most - runs_.size()) return {};
        if (n < 0)
            runs_.insert(runs_.end(), chunk.begin(), chunk.begin() - n);
        else
            runs_.insert(runs_.end(), count, chunk[0]);
        chunk = chunk.subspan(taken);
    }
    if (runs_.size() < wanted) return {};
    texels_.resize(runs_.size());
    restore_zip_bytes(runs_.data(), runs_.size(), texels_.data());
    return std::span(texels_).first(wanted);
}

}  // namespace tex::inline v1
