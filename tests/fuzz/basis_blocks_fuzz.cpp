// SPDX-License-Identifier: Apache-2.0
// Blocks of UASTC and ETC1S of any bytes decode, each to the same texels alone as in a row; UASTC that is not valid is
// magenta, and ETC1S does not look at bits that ETC1S does not have. Transcoders take any block, and the entries of a
// block of UASTC or BC7 are what it decodes to.

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "blocks/bc7.h"
#include "blocks/block_entries.h"
#include "blocks/etc1s.h"
#include "blocks/uastc.h"
#include "blocks/uastc_to.h"
#include "rows/decode_rows.h"

namespace {

constexpr int kTexels = 16;

void decode_one(tex::Format format, const std::byte* block, std::uint8_t codes[4][kTexels]) {
    if (format == tex::Format::uastc_4x4_unorm) return tex::decode_uastc(block, codes);
    std::uint8_t* const colors[3] = {codes[0], codes[1], codes[2]};
    tex::decode_etc1s(block, colors);
    std::uint8_t* const alpha[3] = {nullptr, codes[3], nullptr};
    if (format == tex::Format::etc1s_rgba_unorm) tex::decode_etc1s(block + tex::kEtc1sBlockBytes, alpha);
}

void check_row(tex::Format format, const std::byte* blocks, std::size_t count) {
    const tex::FormatInfo info = tex::format_info(format);
    const auto width = static_cast<std::ptrdiff_t>(4 * count);
    std::vector<float> values[4];
    tex::ChannelRows rows;
    for (int c = 0; c < info.channels; ++c) {
        values[c].resize(static_cast<std::size_t>(4 * width));
        rows.channel[c] = values[c].data();
    }
    tex::decode_row(format, blocks, static_cast<int>(width), rows, width);
    for (std::size_t b = 0; b < count; ++b) {
        std::uint8_t codes[4][kTexels];
        decode_one(format, blocks + b * info.block_bytes, codes);
        for (int c = 0; c < info.channels; ++c) {
            for (std::size_t k = 0; k < kTexels; ++k) {
                const float value = values[c][k / 4 * static_cast<std::size_t>(width) + 4 * b + k % 4];
                if (value != static_cast<float>(codes[c][k]) / 255.0f) std::abort();
            }
        }
    }
}

// The bits that say that there are two halves, and what differs between them.
void check_halves(const std::byte* block) {
    std::byte other[tex::kEtc1sBlockBytes];
    std::memcpy(other, block, sizeof other);
    for (int c = 0; c < 3; ++c) other[c] ^= std::byte{7};
    other[3] ^= std::byte{0x1f};
    std::uint8_t codes[2][3][kTexels];
    std::uint8_t* const first[3] = {codes[0][0], codes[0][1], codes[0][2]};
    std::uint8_t* const second[3] = {codes[1][0], codes[1][1], codes[1][2]};
    tex::decode_etc1s(block, first);
    tex::decode_etc1s(other, second);
    if (std::memcmp(codes[0], codes[1], sizeof codes[0]) != 0) std::abort();
}

void check_entries(const tex::BlockEntries& entries, const std::byte* block, const std::uint8_t decoded[kTexels][4]) {
    std::uint8_t numbers[kTexels];
    std::byte same[16];
    tex::read_entry_numbers(entries, block, numbers);
    for (int k = 0; k < kTexels; ++k) {
        const int n = entries.subset[k] * entries.count + numbers[k];
        if (n >= tex::BlockEntries::kMost || std::memcmp(entries.code[n], decoded[k], 4) != 0) std::abort();
    }
    tex::write_entry_numbers(entries, block, numbers, same);
    if (std::memcmp(same, block, static_cast<std::size_t>(entries.front_bytes())) != 0) std::abort();
}

void check_one(const std::byte* block) {
    std::uint8_t codes[4][kTexels], rgba[kTexels][4], rgb[kTexels][3];
    std::uint16_t shown[kTexels][4];
    std::byte made[16];
    tex::uastc_to_bc7(block, made);
    tex::uastc_to_bc1(block, made);
    tex::uastc_to_etc1(block, rgb);
    tex::uastc_to_astc(block, shown);
    tex::decode_bc7(block, rgba);
    check_entries(tex::read_bc7_entries(block), block, rgba);
    tex::decode_uastc(block, codes);
    for (int k = 0; k < kTexels; ++k) {
        for (int c = 0; c < 4; ++c) rgba[k][c] = codes[c][k];
    }
    check_entries(tex::read_uastc_entries(block), block, rgba);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    constexpr std::size_t kMostBlocks = 64;
    const auto* const blocks = reinterpret_cast<const std::byte*>(data);
    for (const tex::Format format :
         {tex::Format::uastc_4x4_unorm, tex::Format::etc1s_rgb_unorm, tex::Format::etc1s_rgba_unorm}) {
        const std::size_t count = size / tex::format_info(format).block_bytes;
        if (count > 0) check_row(format, blocks, count < kMostBlocks ? count : kMostBlocks);
    }
    if (size >= tex::kEtc1sBlockBytes) check_halves(blocks);
    for (std::size_t b = 0; b < kMostBlocks && 16 * (b + 1) <= size; ++b) check_one(blocks + 16 * b);
    return 0;
}
