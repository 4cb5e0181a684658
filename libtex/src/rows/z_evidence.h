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
    // Whether no filter, compression or strength of normals explains it. They make vectors shorter, but not most of
    // them shorter than 0.45 (real maps: at most 4 % of the texels; heights and roughness in blue: 16 to 100 %); or
    // shorter and longer, but then z still follows x and y (JPEG of quality 50: a correlation of at least 0.19).
    [[nodiscard]] bool is_surely_something_else() const;
    // The share of texels whose x and y lie outside the unit circle, which are not judged.
    [[nodiscard]] double beyond() const;
    // Between z and rebuilt z, where vectors are longer than 0.5.
    [[nodiscard]] double correlation() const { return long_.correlation(); }

private:
    // Sums of values in 1/1024.
    struct Sums {
        std::int64_t count = 0;
        std::int64_t z = 0, rebuilt = 0, z_square = 0, rebuilt_square = 0, product = 0;

        void add(std::int64_t stored, std::int64_t own);
        void add(const Sums& other);
        [[nodiscard]] double mean(std::int64_t sum) const;
        [[nodiscard]] double rebuilt_variance() const;
        [[nodiscard]] double correlation() const;  // 0 if one of the two does not vary
    };

    std::int64_t beyond_ = 0;
    std::int64_t short_ = 0;             // vectors shorter than 0.45
    std::int64_t over_ = 0, under_ = 0;  // texels whose z is clearly greater than the rebuilt one, and less
    std::int64_t off_ = 0;               // of |z - rebuilt z|, in 1/1024, where vectors are longer than 0.5
    Sums long_;                          // vectors longer than 0.5
    Sums all_;                           // longer than 0.1: all but a grey background
};

}  // namespace tex::inline v1
