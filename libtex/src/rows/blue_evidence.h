// SPDX-License-Identifier: Apache-2.0
// blue_evidence.h: whether blue holds z in the usual way, z itself, or nothing.

#pragma once

#include <cstdint>
#include <limits>

namespace tex::inline v1 {

// Looks at texels of a map of unorm values, row by row. Sums depend on the order of rows.
class BlueEvidence {
public:
    // Adds a row of all channels, in R, G, B, A. Those that the map lacks are null; R, G and B are there.
    void add_row(const float* const (&channels)[4], int width);

    // Whether the rows that are still to come cannot change anything.
    [[nodiscard]] bool is_certain() const;
    // R, B and A, if it is there, are 1 everywhere, and G varies: DXT5nm whose alpha, which held x, is gone.
    [[nodiscard]] bool lacks_x() const;
    // Vectors have unit length if B is z, from 0 to 1, and not if it is (z + 1) / 2. Of 209 real maps, 2 were so: their
    // squared lengths are off by 0.002, or read in the usual way by 0.18. The others are nearer to the usual reading,
    // except those whose blue is damaged, at 0.03 and 0.11, and flat ones, at 0.002 and 0.015.
    [[nodiscard]] bool is_z01() const;

private:
    float least_[4] = {1.0f, 1.0f, 1.0f, 1.0f};
    float greatest_green_ = 0.0f;
    std::int64_t tilted_ = 0;  // texels that are not flat
    double off_z01_ = 0.0, off_usual_ = 0.0;
};

}  // namespace tex::inline v1
