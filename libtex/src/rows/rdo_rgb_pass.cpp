// SPDX-License-Identifier: Apache-2.0

#include "rows/rdo_rgb_pass.h"

#include <algorithm>
#include <cmath>

#include "kernels/entry_search.h"
#include "rows/rdo_copy_pass.h"

namespace tex::inline v1 {
namespace {

class RgbKind {
public:
    using Texels = RdoRgbTexels;
    using Shape = RdoRgbEntries;
    static constexpr RdoReach kReach = {16, 2.0f};

    explicit RgbKind(const RdoRgbBand& band) : band_(band) {}

    [[nodiscard]] Shape shape_of(const std::byte* bytes) const { return band_.entries(bytes); }
    [[nodiscard]] static bool has_front(const Shape& shape) { return shape.block.count > 1; }
    [[nodiscard]] static RdoLine line_of(const Shape& shape);
    static void decode(const Shape& shape, const std::byte* bytes, Texels& texels) {
        decode_rgb_entries(shape, bytes, texels);
    }
    [[nodiscard]] static const float* x(const Texels& texels) { return texels.value[0]; }
    [[nodiscard]] static const float* y(const Texels& texels) { return texels.value[1]; }

    void start(int block) { its_ = &band_.blocks[static_cast<std::size_t>(block)]; }
    [[nodiscard]] RdoSearched searched() const {
        const float(*const value)[16] = its_->texels.value;
        float steepness = 0.0f;
        for (int k = 0; k < 16; ++k) {
            const float zz = value[2][k] * value[2][k];
            steepness += std::sqrt(1.0f + 0.5f * (1.0f - zz) / std::max(0.05f, zz));
        }
        // The mean of some lengths is about 0.9 of the root of their mean square.
        return {0, value[0], value[1], 0.9f * kDegreesOfShortChord * steepness / 4.0f, 0.0f};
    }
    [[nodiscard]] float chord_sum(const Texels& texels) const {
        float squares[16];
        squared_distances(its_->texels.value, texels.value, squares);
        return rgb_chord_sum(*its_, squares);
    }
    [[nodiscard]] float degrees(const Texels& texels) const {
        float squares[16], sums[4] = {};
        squared_distances(its_->texels.value, texels.value, squares);
        for (int k = 0; k < 16; ++k) sums[k % 4] += squares[k];
        return 0.9f * 4.0f * kDegreesOfShortChord * std::sqrt((sums[0] + sums[2]) + (sums[1] + sums[3]));
    }
    int write_front(const Shape& shape, const std::byte* from, std::byte* to, Texels& texels) {
        float found[16];
        closest_entries({its_->texels.value, shape.value, shape.block.total(), shape.row, shape.distances},
                        front_squares_, found);
        std::uint8_t numbers[16];
        for (int k = 0; k < 16; ++k) {
            const auto n = static_cast<int>(found[k]);
            numbers[k] = static_cast<std::uint8_t>(n % shape.block.count);
            for (int c = 0; c < 4; ++c) texels.value[c][k] = shape.value[c][n];
        }
        write_entry_numbers(shape.block, from, numbers, to);
        return shape.block.front_bytes();
    }
    [[nodiscard]] float front_sum(const Texels& /*texels*/) const { return rgb_chord_sum(*its_, front_squares_); }
    [[nodiscard]] RdoAngles angles(const Texels& texels) const { return rgb_angles(*its_, texels); }
    [[nodiscard]] double plain_sum() const { return its_->plain_sum; }
    // Squares consist of whole blocks of 4x4 texels.
    [[nodiscard]] static bool is_divided() { return false; }
    [[nodiscard]] static std::vector<double> growths(const Texels& /*texels*/) { return {}; }

private:
    const RdoRgbBand& band_;
    const RdoRgbBlock* its_ = nullptr;
    float front_squares_[16] = {};
};

// The line of one subset.
RdoLine RgbKind::line_of(const Shape& shape) {
    RdoLine line;
    const BlockEntries& block = shape.block;
    line.literals = static_cast<float>(kRdoBlockBytes - block.front_bytes());
    if (block.subsets > 1) return line;
    const int last[2] = {(1 << block.bits[0]) - 1, ((1 << block.bits[1]) - 1) << block.bits[0]};
    float step[2][2], middle[2];  // by plane and component
    for (int c = 0; c < 2; ++c) {
        const float* const value = shape.value[c];
        for (int plane = 0; plane < 2; ++plane) {
            const int other = last[1 - plane];  // the mean of both edges
            step[plane][c] = 0.5f * (value[last[plane]] - value[0] + value[last[plane] + other] - value[other]);
        }
        middle[c] = 0.25f * (value[0] + value[last[0]] + value[last[1]] + value[last[0] + last[1]]);
    }
    float squares[2], noise = 0.0f;
    for (int plane = 0; plane < 2; ++plane) {
        squares[plane] = step[plane][0] * step[plane][0] + step[plane][1] * step[plane][1];
        const auto steps = static_cast<float>((1 << block.bits[plane]) - 1);
        if (steps > 0.0f) noise += 16.0f * squares[plane] / (12.0f * steps * steps);
    }
    const int along = squares[0] >= squares[1] ? 0 : 1;
    line.set(middle, step[along], step[1 - along], noise);
    return line;
}

}  // namespace

std::unique_ptr<RdoRuns> rdo_rgb_pass(const RdoRgbBand& band, const ByteCounts& literals) {
    return std::make_unique<RdoCopyPass<RgbKind>>(band, literals);
}

}  // namespace tex::inline v1
