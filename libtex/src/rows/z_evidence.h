// SPDX-License-Identifier: Apache-2.0
// z_evidence.h: whether the channel that is taken for z holds z.

#pragma once

#include <algorithm>
#include <cstdint>

namespace tex::inline v1 {

// The distance between the rows that are looked at, about 64 of them.
[[nodiscard]] inline int z_step(int height) { return std::max(1, height / 64); }

// Whether the channel of z follows x and y. In maps of people z correlates with sqrt(1 - x^2 - y^2) by 0.84 and more;
// occlusion in its place, by 0.55 and less. The sign of z is ignored, so that maps in object space follow, too. Sums
// are whole numbers, so that the order of rows does not matter.
class ZEvidence {
public:
    void add_row(const float* x, const float* y, const float* z, bool is_unsigned, int width);
    void add(const ZEvidence& other);
    [[nodiscard]] bool is_something_else() const;
    // The share of texels whose x and y lie outside the unit circle, which are not judged.
    [[nodiscard]] double beyond() const;

private:
    std::int64_t beyond_ = 0;
    std::int64_t count_ = 0, off_ = 0;  // of |z - rebuilt z|, in 1/1024
    std::int64_t z_ = 0, rebuilt_ = 0, z_square_ = 0, rebuilt_square_ = 0, product_ = 0;
};

}  // namespace tex::inline v1
