// SPDX-License-Identifier: Apache-2.0

#include "formats/exr/exr_chunk.h"

namespace tex {
namespace {

// Runs: a byte n from 0 to 127 repeats the next byte n + 1 times; a byte -n from -1 to -128 precedes n bytes that are
// copied.
std::size_t unrolled_size(std::span<const std::byte> runs) {
    std::size_t total = 0;
    for (std::size_t at = 0; at + 1 < runs.size();) {
        const int n = static_cast<signed char>(runs[at]);
        total += static_cast<std::size_t>(n < 0 ? -n : n + 1);
        at += static_cast<std::size_t>(n < 0 ? 1 - n : 2);
    }
    return total;
}

}  // namespace

int chunk_lines(Imf::Compression compression) {
    switch (compression) {
        case Imf::ZIP_COMPRESSION:
        case Imf::PXR24_COMPRESSION: return 16;
        case Imf::PIZ_COMPRESSION:
        case Imf::B44_COMPRESSION:
        case Imf::B44A_COMPRESSION:
        case Imf::DWAA_COMPRESSION: return 32;
        case Imf::DWAB_COMPRESSION: return 256;
        default: return 1;
    }
}

bool chunk_is_whole(Imf::Compression compression, std::span<const std::byte> chunk, std::size_t wanted) {
    if (chunk.empty()) return wanted == 0;
    if (chunk.size() >= wanted) return true;  // stored uncompressed, whatever the compression
    switch (compression) {
        case Imf::NO_COMPRESSION: return false;
        case Imf::RLE_COMPRESSION: return unrolled_size(chunk) >= wanted;
        default: return true;
    }
}

}  // namespace tex
