// SPDX-License-Identifier: Apache-2.0

#include "formats/exr/exr_chunk.h"

#include <libdeflate.h>

#include <new>

#include "formats/exr/exr.h"

namespace tex {
namespace {

constexpr std::byte kPredicted{128};

// ZIP stores the difference of each byte from the previous one. Before that, it sorts the bytes: first all at even
// places, then the others.
void undo_prediction(std::byte* bytes, std::size_t size) {
    auto last = static_cast<unsigned>(kPredicted);
    for (std::size_t k = 0; k < size; ++k) {
        last += static_cast<unsigned>(bytes[k]) - static_cast<unsigned>(kPredicted);
        bytes[k] = static_cast<std::byte>(last);
    }
}

void interleave(const std::byte* sorted, std::size_t size, std::byte* out) {
    const std::byte* odd = sorted + (size + 1) / 2;
    for (std::size_t k = 0; k < size / 2; ++k) {
        out[2 * k] = sorted[k];
        out[2 * k + 1] = odd[k];
    }
    if (size % 2 != 0) out[size - 1] = sorted[size / 2];
}

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

const char* inflater_version() { return LIBDEFLATE_VERSION_STRING; }

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

Unzipper::Unzipper() : inflater_(libdeflate_alloc_decompressor(), libdeflate_free_decompressor) {
    if (!inflater_) throw std::bad_alloc();
}

std::span<const std::byte> Unzipper::texels(std::span<const std::byte> chunk, std::size_t wanted, std::size_t most) {
    if (chunk.size() >= wanted) return chunk.first(wanted);  // stored uncompressed, if compression does not help
    inflated_.resize(most);
    std::size_t size = 0;
    const libdeflate_result result =
        libdeflate_zlib_decompress(inflater_.get(), chunk.data(), chunk.size(), inflated_.data(), most, &size);
    if (result != LIBDEFLATE_SUCCESS || size < wanted) return {};
    texels_.resize(most);
    undo_prediction(inflated_.data(), size);
    interleave(inflated_.data(), size, texels_.data());
    return std::span(texels_).first(wanted);
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
