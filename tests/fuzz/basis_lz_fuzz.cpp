// SPDX-License-Identifier: Apache-2.0
// Codebooks and slices of BasisLZ of any bytes are decoded or refused. What is decoded consists of entries of the
// codebooks, and a second pass gives the same blocks.
//
// Input: blocks across and down (a byte each), bytes of the slice (two bytes), the slice, the header of the global
// data, the codebooks.

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "formats/ktx2/basis_slice.h"

namespace {

bool has(const std::vector<tex::BasisCodebooks::Half>& halves, const std::byte* half) {
    return std::any_of(halves.begin(), halves.end(),
                       [&](const tex::BasisCodebooks::Half& h) { return std::equal(h.begin(), h.end(), half); });
}

// Nothing if the slice is refused.
std::vector<std::byte> blocks_of(const tex::BasisCodebooks& books, std::span<const std::byte> slice, int across,
                                 int down) {
    constexpr std::size_t kStride = 16;  // with room for a block of alpha
    tex::BasisSlice rows(books, slice, across, down);
    std::vector<std::byte> blocks(kStride * static_cast<std::size_t>(across) * static_cast<std::size_t>(down));
    for (int j = 0; j < down; ++j) {
        std::byte* const row = blocks.data() + kStride * static_cast<std::size_t>(j) * static_cast<std::size_t>(across);
        if (!rows.next_row(row, kStride)) return {};
    }
    return blocks;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    constexpr std::size_t kChoices = 4;
    if (size < kChoices + tex::kBasisHeaderBytes) return 0;
    const std::span<const std::byte> all(reinterpret_cast<const std::byte*>(data), size);
    const int across = data[0] % 48 + 1, down = data[1] % 48 + 1;
    const std::size_t in_slice =
        std::min(data[2] | std::size_t{data[3]} << 8, size - kChoices - tex::kBasisHeaderBytes);
    const auto slice = all.subspan(kChoices, in_slice);
    const auto head = all.subspan(kChoices + in_slice, tex::kBasisHeaderBytes);
    const auto books = tex::read_basis_codebooks(head, all.subspan(kChoices + in_slice + tex::kBasisHeaderBytes));
    if (!books) return 0;
    const std::vector<std::byte> blocks = blocks_of(*books, slice, across, down);
    if (blocks != blocks_of(*books, slice, across, down)) std::abort();
    for (std::size_t at = 0; at < blocks.size(); at += 16) {
        if (!has(books->endpoints, blocks.data() + at) || !has(books->selectors, blocks.data() + at + 4)) std::abort();
    }
    return 0;
}
