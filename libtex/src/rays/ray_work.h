// SPDX-License-Identifier: Apache-2.0
// ray_work.h: limits what rays cost, so that no mesh takes time out of proportion to the map that is wanted.

#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <tex/types.h>

#include "kernels/trace.h"

namespace tex::inline v1 {

// What rays, or searches for the nearest point, have cost. A step is a look at a box or at a group of triangles. Rays
// of meshes that people make take 10 to 100 steps; where thousands of triangles lie over each other, or are so long and
// thin that their boxes do, each ray takes thousands.
class RayWork {
public:
    static constexpr std::int64_t kMostSteps = 2048;  // of a ray, on average
    static constexpr std::int64_t kReserve = 512;     // rays, so that a few costly ones do not matter

    void add(std::int64_t rays, std::int64_t steps) {
        rays_ += rays;
        steps_ += steps;
    }
    // Whether they may go on. Work that is counted apart for each piece of a map ends in the same place for every
    // number of threads.
    [[nodiscard]] bool is_fair() const { return steps_ <= kMostSteps * (rays_ + kReserve); }

    [[nodiscard]] std::int64_t rays() const { return rays_; }
    [[nodiscard]] std::int64_t steps() const { return steps_; }

private:
    std::int64_t rays_ = 0, steps_ = 0;
};

// trace_rays(), until the work is not fair any more. The hits of the other rays are unchanged.
void trace_fairly(const TreeView& tree, const Ray* rays, std::size_t count, RayHit* hits, RayWork& work);
// find_blocked(), likewise.
void find_blocked_fairly(const TreeView& tree, const Ray* rays, std::size_t count, std::uint8_t* blocked,
                         RayWork& work);

// The mesh whose triangles are looked at.
enum class RaySide { low, high };

// The first piece of a map, or of a mesh, whose work is not fair. Any thread may call its functions.
class CostlyPiece {
public:
    void see(int piece, RaySide side);
    // Whether there is one before this piece, whose own work does not matter then.
    [[nodiscard]] bool is_before(int piece) const { return first_.load(std::memory_order_relaxed) / 2 < piece; }
    // Errors: unsupported, if there is one.
    [[nodiscard]] Result<void> check() const;

private:
    std::atomic<std::int64_t> first_{std::numeric_limits<std::int64_t>::max()};  // twice its number, and the side
};

}  // namespace tex::inline v1
