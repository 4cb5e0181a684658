// SPDX-License-Identifier: Apache-2.0

#include "rays/ray_work.h"

#include <algorithm>
#include <string>

namespace tex::inline v1 {
namespace {

constexpr std::size_t kRaysPerLook = 64;  // whole packets

}  // namespace

void trace_fairly(const TreeView& tree, const Ray* rays, std::size_t count, RayHit* hits, RayWork& work) {
    for (std::size_t first = 0; first < count && work.is_fair(); first += kRaysPerLook) {
        const std::size_t some = std::min(count - first, kRaysPerLook);
        work.add(static_cast<std::int64_t>(some), trace_rays(tree, rays + first, some, hits + first));
    }
}

void find_blocked_fairly(const TreeView& tree, const Ray* rays, std::size_t count, std::uint8_t* blocked,
                         RayWork& work) {
    for (std::size_t first = 0; first < count && work.is_fair(); first += kRaysPerLook) {
        const std::size_t some = std::min(count - first, kRaysPerLook);
        work.add(static_cast<std::int64_t>(some), find_blocked(tree, rays + first, some, blocked + first));
    }
}

void CostlyPiece::see(int piece, RaySide side) {
    const std::int64_t mine = 2 * std::int64_t{piece} + (side == RaySide::high ? 1 : 0);
    std::int64_t first = first_.load(std::memory_order_relaxed);
    while (mine < first && !first_.compare_exchange_weak(first, mine, std::memory_order_relaxed)) {
    }
}

Result<void> CostlyPiece::check() const {
    const std::int64_t first = first_.load(std::memory_order_relaxed);
    if (first == std::numeric_limits<std::int64_t>::max()) return {};
    const std::string of = first % 2 == 1 ? "triangles of the high mesh" : "of its triangles";
    return Error{ErrorCode::unsupported,
                 {},
                 "too many " + of +
                     " lie over each other, or are long and thin: each ray would be tested against "
                     "thousands. Remove those that lie over others, and divide long ones"};
}

}  // namespace tex::inline v1
