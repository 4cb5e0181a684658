// SPDX-License-Identifier: Apache-2.0

#include "rows/rdo_astc_pass.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "blocks/astc_decode.h"
#include "blocks/astc_ise.h"
#include "blocks/astc_weights.h"
#include "rows/rdo_copy_pass.h"

namespace tex::inline v1 {
namespace {

constexpr float kComponentOfCode = 2.0f / 255.0f;

class AstcKind {
public:
    using Texels = RdoAstcTexels;
    using Shape = std::optional<AstcLines>;
    static constexpr RdoReach kReach = {6, 1.3f};

    explicit AstcKind(const RdoAstcBand& band) : band_(band) {
        for (const auto& grid : astc_plans(band.block).grids)
            grids_[grid->extent.width][grid->extent.height] = grid.get();
    }

    [[nodiscard]] Shape shape_of(const std::byte* bytes) const { return read_astc_lines(band_.block, bytes); }
    [[nodiscard]] static bool has_front(const Shape& shape) { return shape.has_value(); }
    [[nodiscard]] static RdoLine line_of(const Shape& shape);
    void decode(const Shape& /*shape*/, const std::byte* bytes, Texels& texels) const {
        decode_astc_normals(band_.block, bytes, texels);
    }
    [[nodiscard]] static const float* x(const Texels& texels) { return texels.x; }
    [[nodiscard]] static const float* y(const Texels& texels) { return texels.y; }

    void start(int block) {
        index_ = static_cast<std::size_t>(block);
        its_ = &band_.blocks[index_];
        for (int k = 0; k < band_.block_texels; ++k) {
            codes_[0][k] = 127.5f * (its_->x[k] + 1.0f);
            codes_[1][k] = 127.5f * (its_->y[k] + 1.0f);
        }
        float steepness = 0.0f;
        for (int k = 0; k < band_.block_texels; ++k) {
            const float zz = its_->z[k] * its_->z[k];
            steepness += std::sqrt(1.0f + 0.5f * (1.0f - zz) / std::max(0.05f, zz));
        }
        // The mean of some lengths is about 0.9 of the root of their mean square.
        scale_ = 0.9f * kDegreesOfShortChord * steepness / std::sqrt(static_cast<float>(band_.block_texels));
    }
    [[nodiscard]] RdoSearched searched() const { return {0, its_->x, its_->y, scale_, 0.0f}; }
    [[nodiscard]] float chord_sum(const Texels& texels) const {
        return astc_chord_sum(*its_, band_.block_texels, texels);
    }
    [[nodiscard]] float degrees(const Texels& texels) const {
        float sums[4] = {};
        for (int k = 0; k < band_.block_texels; k += 4) {
            for (int n = 0; n < 4; ++n) {  // what follows the last texel is 0 in both
                const float dx = its_->x[k + n] - texels.x[k + n], dy = its_->y[k + n] - texels.y[k + n];
                sums[n] += dx * dx + dy * dy;
            }
        }
        return scale_ * std::sqrt((sums[0] + sums[2]) + (sums[1] + sums[3]));
    }
    int write_front(const Shape& shape, const std::byte* from, std::byte* to, Texels& texels) const {
        const Extent grid = shape->mode.grid;
        write_astc_weights(*grids_[grid.width][grid.height], *shape, codes_[0], codes_[1], from, to);
        decode_astc_normals(band_.block, to, texels);
        return front_bytes(*shape);
    }
    [[nodiscard]] float front_sum(const Texels& texels) const { return chord_sum(texels); }
    [[nodiscard]] RdoAngles angles(const Texels& texels) const {
        return astc_angles(*its_, band_.block_texels, texels);
    }
    [[nodiscard]] double plain_sum() const { return its_->plain_sum; }
    [[nodiscard]] bool is_divided() const { return band_.is_divided(index_); }
    [[nodiscard]] std::vector<double> growths(const Texels& texels) const {
        return astc_growths(band_, index_, texels);
    }

private:
    static int front_bytes(const AstcLines& lines) { return (128 - lines.mode.weight_bits()) / 8; }

    const RdoAstcBand& band_;
    const AstcGrid* grids_[9][9] = {};  // by width and height
    std::size_t index_ = 0;
    const RdoAstcBlock* its_ = nullptr;
    float scale_ = 0.0f;
    float codes_[2][kAstcMostPlanned] = {};  // x and y from 0 to 255
};

// The line of one partition. With two planes, it is a rectangle.
RdoLine AstcKind::line_of(const Shape& shape) {
    RdoLine line;
    if (!shape) return line;
    const AstcMode& mode = shape->mode;
    line.literals = static_cast<float>(kRdoBlockBytes - front_bytes(*shape));
    if (shape->partitions > 1) return line;
    float middle[2], step[2];
    for (int c = 0; c < 2; ++c) {
        const int* const ends = shape->ends[0][c];
        middle[c] = 0.5f * static_cast<float>(ends[0] + ends[1]) * kComponentOfCode - 1.0f;
        step[c] = static_cast<float>(ends[1] - ends[0]) * kComponentOfCode;
    }
    const float square = step[0] * step[0] + step[1] * step[1];
    const auto steps = static_cast<float>(kAstcRangeTable[mode.range].levels - 1);
    const auto weights = static_cast<float>(mode.weights() / mode.planes);
    const bool is_line = mode.planes == 1;
    const float along[2] = {is_line ? step[0] : std::fabs(step[0]), is_line ? step[1] : 0.0f};
    const float across[2] = {0.0f, is_line ? 0.0f : step[1]};
    line.set(middle, along, across, weights * square / (12.0f * steps * steps));
    return line;
}

}  // namespace

std::unique_ptr<RdoRuns> rdo_astc_pass(const RdoAstcBand& band, const ByteCounts& literals) {
    return std::make_unique<RdoCopyPass<AstcKind>>(band, literals);
}

}  // namespace tex::inline v1
