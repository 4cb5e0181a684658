// SPDX-License-Identifier: Apache-2.0
// call.h: what the functions of tex_c.h are called with, checked and turned into the types of C++.
//
// The folder c/ is the face of libtex for C: thin over rows/, kernels/, blocks/ and surface/, or over a verb where it
// may allocate. It keeps the promises of tex_c.h: the caller's memory and no other, no exception, no loop over texels
// except copies.

#pragma once

#include <tex/tex_c.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <new>
#include <type_traits>

#include <tex/format.h>
#include <tex/height.h>
#include <tex/types.h>

#include "kernels/normal_row.h"
#include "memory/lent_memory.h"

namespace tex::inline v1 {

inline constexpr std::uint32_t kLargestStructure = 4096;  // more can only be memory that nobody initialised

// Copies a structure of options, as the rules of its ABI say: TEX_OK, TEX_BAD_ARGUMENT or TEX_BAD_OPTION. (All of them
// have the size of their first version.)
template <class Options>
int32_t copy_options(const Options* from, Options& to) {
    static_assert(std::is_trivially_copyable_v<Options>);
    if (from == nullptr || from->size < sizeof(Options) || from->size > kLargestStructure) return TEX_BAD_ARGUMENT;
    const auto* const bytes = reinterpret_cast<const unsigned char*>(from);
    const bool known =
        std::all_of(bytes + sizeof(Options), bytes + from->size, [](unsigned char byte) { return byte == 0; });
    if (!known) return TEX_BAD_OPTION;
    std::memcpy(&to, from, sizeof(Options));
    return TEX_OK;
}

// Whether a report of the caller can be filled.
template <class Report>
bool is_report(const Report* report) {
    return report == nullptr || (report->size >= sizeof(Report) && report->size <= kLargestStructure);
}

// Fills it; what a newer caller knows besides becomes 0.
template <class Report>
void write_report(const Report& from, Report* to) {
    if (to == nullptr) return;
    const std::uint32_t size = to->size;
    std::memset(to, 0, size);
    std::memcpy(to, &from, sizeof(Report));
    to->size = size;
}

// Whether `value` is one of the enumerators, which are numbered from 0 in the order of their names.
template <class Enum, std::size_t kCount>
constexpr bool is_one_of(int32_t value, const Named<Enum> (&)[kCount]) {
    return value >= 0 && value < static_cast<int32_t>(kCount);
}

inline bool is_extent(int32_t width, int32_t height) {
    return width >= 1 && height >= 1 && width <= kMaxExtent && height <= kMaxExtent;
}
inline bool is_plane(const tex_plane* plane) {
    return plane != nullptr && plane->data != nullptr && is_extent(plane->width, plane->height) &&
           plane->stride >= plane->width;
}
inline bool is_map(const tex_map* map, bool with_z = true) {
    return map != nullptr && map->x != nullptr && map->y != nullptr && (map->z != nullptr || !with_z) &&
           is_extent(map->width, map->height) && map->stride >= map->width;
}
template <class A, class B>
bool same_extent(const A& a, const B& b) {
    return a.width == b.width && a.height == b.height;
}
inline bool are_rows(int32_t first, int32_t end, int32_t height) { return first >= 0 && first <= end && end <= height; }
inline bool are_blocks(int32_t first, int32_t end, int32_t height, int block) {
    return are_rows(first, end, height) && first % block == 0 && (end % block == 0 || end == height);
}

inline float* row_of(const tex_plane& plane, int j) { return plane.data + j * plane.stride; }
inline NormalRow row_of(const tex_map& map, int j) {
    const std::ptrdiff_t at = j * map.stride;
    return {map.x + at, map.y + at, map.z + at};
}

// The caller's plane as one that owns nothing.
inline Plane<float> borrowed(float* data, std::ptrdiff_t stride, Extent extent) {
    return {extent, stride, std::shared_ptr<float>(std::shared_ptr<float>(), data)};
}
inline NormalMap borrowed(const tex_map& map) {
    const Extent extent{map.width, map.height};
    NormalMap borrowed_map;
    borrowed_map.x = borrowed(map.x, map.stride, extent);
    borrowed_map.y = borrowed(map.y, map.stride, extent);
    borrowed_map.z = borrowed(map.z, map.stride, extent);
    return borrowed_map;
}

// Sums up the scratch that planes and vectors take (LentMemory).
class ScratchSize {
public:
    void plane(std::int64_t width, std::int64_t height) {
        const auto step = static_cast<std::int64_t>(kRowAlignment / sizeof(float));
        const std::int64_t stride = (width + step - 1) / step * step;
        vector<float>(stride * height);
        bytes_ += LentMemory::taken_by(kControlBlock);
    }
    template <class T>
    void vector(std::int64_t count) {
        bytes_ += LentMemory::taken_by(static_cast<std::size_t>(count) * sizeof(T));
    }
    [[nodiscard]] std::size_t bytes() const { return bytes_ + LentMemory::lost_at_start() + LentMemory::kStep; }

private:
    static constexpr std::size_t kControlBlock = 64;  // of the std::shared_ptr in a Plane
    std::size_t bytes_ = 0;
};

// Runs body() with `scratch` lent to it.
template <class Body>
int32_t with_scratch(void* scratch, std::size_t size, std::size_t wanted, const Body& body) noexcept {
    if (size < wanted) return TEX_SCRATCH_TOO_SMALL;
    if (scratch == nullptr) return TEX_BAD_ARGUMENT;
    try {
        LentMemory memory(scratch, size);
        const Lend lend(memory);
        return body();
    } catch (const std::bad_alloc&) {
        return TEX_SCRATCH_TOO_SMALL;  // cannot happen: tests run every function with exactly the size it states
    }
}

}  // namespace tex::inline v1
