// SPDX-License-Identifier: Apache-2.0
// swizzle_evidence.h: what the texels of four channels show about their layout: the rule of guess_swizzle(), row by
// row.

#pragma once

#include <cmath>
#include <cstdint>

#include <tex/format.h>
#include <tex/types.h>

namespace tex::inline v1 {

class SwizzleEvidence {
public:
    // `head` describes the texture; it needs no levels.
    SwizzleEvidence(Extent extent, const Texture& head);

    // Adds row j of the level: its channels R, G, B and A. Each row comes once and in order. Some rows are skipped.
    void add_row(int j, const float* const (&channels)[4]);

    // Whether the rows that are still to come cannot change the layout.
    [[nodiscard]] bool is_certain() const;

    // The layout, according to what has been added so far, which must include row 0.
    [[nodiscard]] Swizzle layout() const;

private:
    struct Range {
        float least = INFINITY;
        float greatest = -INFINITY;

        void add(float value);
        [[nodiscard]] bool is_constant() const;
    };
    // How far vectors are from unit length.
    struct Errors {
        double rgb = 0.0;
        double rxgb = 0.0;
    };

    static constexpr double kGrey = 4.0 / 255.0;  // the same grey in 5 and in 6 bits differs by this much

    const Extent extent_;
    const bool is_float_;
    const bool x_in_grey_;
    const int step_;  // distance between the texels that are examined
    Range channels_[4];
    Errors signed_;
    Errors unsigned_;
    double off_grey_ = 0.0;
    std::int64_t count_ = 0;
};

}  // namespace tex::inline v1
