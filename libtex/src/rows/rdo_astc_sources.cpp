// SPDX-License-Identifier: Apache-2.0

#include "rows/rdo_astc_sources.h"

#include <algorithm>
#include <cmath>

#include "blocks/astc_ise.h"
#include "rows/rdo_rate.h"

namespace tex::inline v1 {
namespace {

constexpr std::size_t kVectorSlack = 32;  // kernels read and write whole vectors
constexpr float kComponentOfCode = 2.0f / 255.0f;
constexpr float kNoLine = 1e12f;  // the error of blocks that have no line, or several

void coarse_numbers(const float basis[3][kAstcMostPlanned], int texels, const float* const values[2],
                    float coarse[kAstcCoarse]) {
    for (int c = 0; c < 2; ++c) {
        for (int n = 0; n < 3; ++n) {
            float sums[4] = {};
            for (int k = 0; k < texels; ++k) sums[k % 4] += basis[n][k] * values[c][k];
            coarse[3 * c + n] = (sums[0] + sums[2]) + (sums[1] + sums[3]);
        }
    }
}

AstcCopyTexels copy_texels(const float basis[3][kAstcMostPlanned], const RdoAstcBlock& block, int texels) {
    AstcCopyTexels found{static_cast<float>(texels), {}, 0.0f, 0.0f, 0.0f, {}};
    const float* const values[2] = {block.x, block.y};
    coarse_numbers(basis, texels, values, found.coarse);
    const float over = 1.0f / found.texels;
    for (int k = 0; k < texels; ++k) {
        found.mean[0] += over * block.x[k];
        found.mean[1] += over * block.y[k];
    }
    for (int k = 0; k < texels; ++k) {
        const float x = block.x[k] - found.mean[0], y = block.y[k] - found.mean[1];
        found.xx += x * x;
        found.xy += x * y;
        found.yy += y * y;
    }
    return found;
}

}  // namespace

RdoAstcSources::RdoAstcSources(Extent block, int window, std::size_t most)
    : block_(block), texels_(block.width * block.height), reach_(std::max(1, window / kAstcBlockBytes)) {
    for (const auto& grid : astc_plans(block).grids)
        grids_[static_cast<std::size_t>(grid->extent.width)][static_cast<std::size_t>(grid->extent.height)] =
            grid.get();
    // The mean and both slopes.
    float squares[3] = {};
    for (int k = 0; k < texels_; ++k) {
        basis_[0][k] = 1.0f;
        basis_[1][k] = static_cast<float>(2 * (k % block.width) - (block.width - 1));
        basis_[2][k] = static_cast<float>(2 * (k / block.width) - (block.height - 1));
        for (int n = 0; n < 3; ++n) squares[n] += basis_[n][k] * basis_[n][k];
    }
    for (int n = 0; n < 3; ++n) {
        for (int k = 0; k < texels_; ++k) basis_[n][k] /= std::sqrt(squares[n]);
    }
    for (std::vector<float>& column : coarse_) column.resize(most + kVectorSlack);
    for (std::vector<float>* column :
         {&cos_, &sin_, &middle_[0], &middle_[1], &half_[0], &half_[1], &noise_, &literals_})
        column->resize(most + kVectorSlack);
    decoded_.reserve(most);
    lines_.reserve(most);
    const auto farthest = static_cast<std::size_t>(std::min(reach_, static_cast<int>(most)));
    prices_.resize(farthest + kVectorSlack);
    whole_costs_.resize(farthest + kVectorSlack);
    front_costs_.resize(farthest + kVectorSlack);
}

void RdoAstcSources::set_lambda(float lambda) {
    lambda_ = lambda;
    const std::size_t farthest = prices_.size() - kVectorSlack;
    for (std::size_t k = 0; k < farthest; ++k)
        prices_[k] = lambda * match_bits(static_cast<int>(kAstcBlockBytes * (farthest - k)));
}

AstcCopyTable RdoAstcSources::table(std::size_t first) const {
    AstcCopyTable table{};
    for (std::size_t n = 0; n < kAstcCoarse; ++n) table.coarse[n] = coarse_[n].data() + first;
    table.cos = cos_.data() + first;
    table.sin = sin_.data() + first;
    for (std::size_t n = 0; n < 2; ++n) {
        table.middle[n] = middle_[n].data() + first;
        table.half[n] = half_[n].data() + first;
    }
    table.noise = noise_.data() + first;
    table.literals = literals_.data() + first;
    return table;
}

// The line of one partition. With two planes, it is a rectangle.
void RdoAstcSources::add_lines(const AstcLines& lines) {
    const std::size_t at = count_;
    literals_[at] = static_cast<float>(kAstcBlockBytes - (128 - lines.mode.weight_bits()) / 8);
    if (lines.partitions > 1) return;
    float middle[2], step[2];
    for (int c = 0; c < 2; ++c) {
        const int* const ends = lines.ends[0][c];
        middle[c] = 0.5f * static_cast<float>(ends[0] + ends[1]) * kComponentOfCode - 1.0f;
        step[c] = static_cast<float>(ends[1] - ends[0]) * kComponentOfCode;
    }
    const float square = step[0] * step[0] + step[1] * step[1];
    const float length = std::sqrt(square);
    const bool is_line = lines.mode.planes == 1 && length > 0.0f;
    const float cos = is_line ? step[0] / length : 1.0f, sin = is_line ? step[1] / length : 0.0f;
    cos_[at] = cos;
    sin_[at] = sin;
    middle_[0][at] = cos * middle[0] + sin * middle[1];
    middle_[1][at] = cos * middle[1] - sin * middle[0];
    half_[0][at] = 0.5f * (lines.mode.planes == 1 ? length : std::fabs(step[0]));
    half_[1][at] = 0.5f * (lines.mode.planes == 1 ? 0.0f : std::fabs(step[1]));
    const auto steps = static_cast<float>(kAstcRangeTable[lines.mode.range].levels - 1);
    const auto weights = static_cast<float>(lines.mode.weights() / lines.mode.planes);
    noise_[at] = weights * square / (12.0f * steps * steps);
}

void RdoAstcSources::add(const std::byte* bytes, const RdoAstcTexels& decoded) {
    const float* const values[2] = {decoded.x, decoded.y};
    float coarse[kAstcCoarse];
    coarse_numbers(basis_, texels_, values, coarse);
    for (std::size_t n = 0; n < kAstcCoarse; ++n) coarse_[n][count_] = coarse[n];
    decoded_.push_back(decoded);
    noise_[count_] = kNoLine;
    cos_[count_] = 1.0f;
    lines_.push_back(read_astc_lines(block_, bytes));
    if (lines_.back()) add_lines(*lines_.back());
    ++count_;
}

float RdoAstcSources::squared_distance(const RdoAstcBlock& block, int at) const {
    const RdoAstcTexels& other = decoded(at);
    float sums[4] = {};
    for (int k = 0; k < kAstcMostPlanned && k < texels_; k += 4) {
        for (int n = 0; n < 4; ++n) {  // what follows the last texel is 0 in both
            const float x = block.x[k + n] - other.x[k + n], y = block.y[k + n] - other.y[k + n];
            sums[n] += x * x + y * y;
        }
    }
    return (sums[0] + sums[2]) + (sums[1] + sums[3]);
}

void RdoAstcSources::find(const RdoAstcSearcher& block) {
    constexpr int kMostWholes = 4, kMostFronts = 6;
    // Estimates err: so what seems to cost a little more than the block as it is is still tried.
    constexpr float kOverPlain = 1.3f;
    const int first = std::max(0, block.number - reach_);
    const int count = block.number - first;
    const float* const prices = prices_.data() + (prices_.size() - kVectorSlack - static_cast<std::size_t>(count));
    astc_copy_costs(table(static_cast<std::size_t>(first)), copy_texels(basis_, *block.texels, texels_), prices,
                    block.scale, lambda_ * kUsualLiteral, count, whole_costs_.data(), front_costs_.data());
    // Among equal costs, the later block comes first.
    CheapCopies wholes(kOverPlain * block.cost, kMostWholes), fronts(kOverPlain * block.cost, kMostFronts);
    for (int k = count - 1; k >= 0; --k) {
        const auto at = static_cast<std::size_t>(k);
        if (front_costs_[at] < fronts.bound()) fronts.add({front_costs_[at], first + k, 0});
        if (whole_costs_[at] >= wholes.bound()) continue;
        const float length = std::sqrt(squared_distance(*block.texels, first + k));
        wholes.add({block.scale * length + prices[k], first + k, 0});
    }
    wholes_.clear();
    for (const CheapCopy& copy : wholes) wholes_.push_back(copy.at);
    fronts_.clear();
    for (const CheapCopy& copy : fronts) fronts_.push_back(copy.at);
}

}  // namespace tex::inline v1
