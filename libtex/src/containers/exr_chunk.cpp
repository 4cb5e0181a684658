// SPDX-License-Identifier: Apache-2.0

#include "containers/exr_chunk.h"

#include <zlib.h>

#include <limits>

namespace tex {
namespace {

// Bytes that the zlib stream inflates to, up to `most`.
std::size_t inflated_size(const std::byte* data, std::size_t size, std::size_t most) {
    z_stream stream{};
    if (size > std::numeric_limits<uInt>::max() || inflateInit(&stream) != Z_OK) return 0;
    // zlib's interface predates const.
    stream.next_in = const_cast<Bytef*>(reinterpret_cast<const Bytef*>(data));
    stream.avail_in = static_cast<uInt>(size);
    Bytef nowhere[1 << 15];
    int status = Z_OK;
    while (status == Z_OK && stream.total_out < most) {
        stream.next_out = nowhere;
        stream.avail_out = sizeof nowhere;
        status = inflate(&stream, Z_NO_FLUSH);
    }
    const std::size_t total = stream.total_out;
    inflateEnd(&stream);
    return total;
}

// Runs: a byte n of 0 to 127 repeats the next byte n + 1 times, one of -1 to -128 stands before that many bytes.
std::size_t unrolled_size(const std::byte* data, std::size_t size) {
    std::size_t total = 0;
    for (std::size_t at = 0; at + 1 < size;) {
        const int n = static_cast<signed char>(data[at]);
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

bool chunk_is_whole(Imf::Compression compression, const std::byte* data, std::size_t size, std::size_t wanted) {
    if (size == 0) return wanted == 0;
    if (size >= wanted) return true;  // stored without compression, whatever the compression
    switch (compression) {
        case Imf::NO_COMPRESSION: return false;
        case Imf::RLE_COMPRESSION: return unrolled_size(data, size) >= wanted;
        case Imf::ZIP_COMPRESSION:
        case Imf::ZIPS_COMPRESSION: return inflated_size(data, size, wanted) >= wanted;
        default: return true;
    }
}

}  // namespace tex
