// SPDX-License-Identifier: Apache-2.0
// coverage.h: which triangle covers each texel of a map.

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <tex/mesh.h>
#include <tex/types.h>

namespace tex::inline v1 {

inline constexpr std::int32_t kNoTriangle = -1;

// A texel's place on a triangle: weights of its corners, which sum to 1. In the gutter, weights may be negative, down
// to -1.
struct Covered {
    std::int32_t triangle = kNoTriangle;
    bool inside = false;
    bool is_moved = false;  // the triangle, by whole repeats
    std::array<double, 3> weights{};
};

// How often one more triangle covers a texel: of the same rank as the one that decides, or one from outside of 0 to 1
// (mesh.h, "convert").
struct Overlaps {
    std::int64_t same = 0, moved = 0;

    void add(const Overlaps& other) {
        same += other.same;
        moved += other.moved;
    }
};

// The triangles of a part in texels, x to the right, y down, sorted by the strips of rows that they touch.
class CoverageMap {
public:
    // `gutter` is its width in texels. Strips have a multiple of `rows` rows, except the last one. Errors: unsupported,
    // as described in mesh.h.
    static Result<CoverageMap> make(const MeshPart& part, int uv_set, Extent extent, int gutter, int rows = 1);

    [[nodiscard]] int strip_rows() const { return strip_rows_; }
    [[nodiscard]] int strips() const { return (extent_.height + strip_rows_ - 1) / strip_rows_; }
    // Fills the texels of a strip, row by row.
    Overlaps cover(int strip, std::vector<Covered>& texels) const;

private:
    struct Placed {
        std::int32_t triangle;
        std::array<std::int64_t, 3> x, y;  // in kSteps a texel, moved by whole repeats
        bool is_moved = false;             // by one or more
    };
    struct Box {
        int left, right, top, bottom;  // texels, right and bottom included
    };
    [[nodiscard]] std::size_t place_of(int i, int j, int strip) const {
        return static_cast<std::size_t>(j - strip * strip_rows_) * static_cast<std::size_t>(extent_.width) +
               static_cast<std::size_t>(i);
    }
    [[nodiscard]] Box box_of(const Placed& t, int margin, int strip) const;
    void cover_inside(const Placed& t, int strip, std::vector<Covered>& texels, Overlaps& overlaps) const;
    void cover_gutter(const Placed& t, int strip, std::vector<Covered>& texels, std::vector<double>& nearest) const;
    Result<void> place(const MeshPart& part, const std::vector<Float2>& uvs, std::int32_t triangle);
    Result<void> add(const Placed& placed, std::size_t triangles);

    Extent extent_;
    int gutter_ = 0;
    int strip_rows_ = 1;
    std::int64_t tests_ = 0;    // of a texel against a triangle
    std::int64_t entries_ = 0;  // in by_strip_
    std::vector<Placed> placed_;
    std::vector<std::vector<std::uint32_t>> by_strip_;
};

}  // namespace tex::inline v1
