// SPDX-License-Identifier: Apache-2.0

#include "formats/ktx2/unclaimed_bytes.h"

#include <algorithm>

namespace tex::inline v1 {
namespace {

constexpr std::uint64_t kLongestAlignment = 16;  // of levels: a texel block, or a texel of four floats
// Some writers begin levels at pages. Longer gaps are not read: they count.
constexpr std::uint64_t kLongestPadding = std::uint64_t{1} << 16;

Result<bool> is_padding(const FetchBytes& fetch, std::uint64_t begin, std::uint64_t count) {
    if (count < kLongestAlignment) return true;
    if (count > kLongestPadding) return false;
    const Result<std::vector<std::byte>> bytes = fetch(begin, static_cast<std::size_t>(count));
    if (!bytes) return bytes.error();
    return std::all_of(bytes->begin(), bytes->end(), [](std::byte byte) { return byte == std::byte{0}; });
}

}  // namespace

Result<std::uint64_t> unclaimed_bytes(const FetchBytes& fetch, std::uint64_t size, std::vector<ClaimedBytes> ranges) {
    ranges.push_back({size, 0});
    std::sort(ranges.begin(), ranges.end(),
              [](const ClaimedBytes& a, const ClaimedBytes& b) { return a.begin < b.begin; });
    std::uint64_t total = 0, reached = 0;
    for (const ClaimedBytes& range : ranges) {
        if (range.begin > size) break;
        if (range.begin > reached) {
            const Result<bool> padding = is_padding(fetch, reached, range.begin - reached);
            if (!padding) return padding.error();
            if (!*padding) total += range.begin - reached;
        }
        reached = std::max(reached, range.begin + std::min(range.count, size - range.begin));
    }
    return total;
}

}  // namespace tex::inline v1
