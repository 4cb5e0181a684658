// SPDX-License-Identifier: Apache-2.0
// straight_border.h: rows with two more texels at each end, for second differences that bend nothing at a border.

#pragma once

#include <tex/height.h>
#include <tex/types.h>

namespace tex::inline v1 {

// The texels beyond each end of a row.
inline constexpr int kStraightApron = 2;

// A row with room for those, and for whole vectors.
class ApronRow {
public:
    explicit ApronRow(int width) : row_(Extent{kLead + width + kTail, 1}, 0.0f) {}
    [[nodiscard]] float* data() { return row_.row(0) + kLead; }
    [[nodiscard]] const float* data() const { return row_.row(0) + kLead; }

private:
    static constexpr int kLead = 16;
    static constexpr int kTail = 64;
    Plane<float> row_;
};

// Writes what lies beyond the ends of a row of `width` texels. Axes repeat or are mirrored as in border.h; with
// Wrap::clamp, the straight line through the last two texels continues.
void continue_ends(float* row, int width, Wrap wrap);

// Writes row j of `plane`, from kStraightApron rows above it to as many below it, without its ends.
void straight_row(const Plane<float>& plane, Wrap wrap_y, int j, float* out);

}  // namespace tex::inline v1
