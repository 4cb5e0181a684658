// SPDX-License-Identifier: Apache-2.0

#include "rows/rdo_rgb_sources.h"

#include <algorithm>
#include <cmath>

#include "kernels/copy_search.h"
#include "kernels/entry_search.h"
#include "rows/rdo_rate.h"

namespace tex::inline v1 {
namespace {

constexpr std::size_t kRgbVectorSlack = 32;  // kernels read and write whole vectors
constexpr int kRgbBytes = 16;
constexpr float kNoRgbLine = 1e12f;  // the error of blocks that have no line, or several

void coarse_numbers_of(const float basis[3][16], const RdoRgbTexels& texels, float coarse[kAstcCoarse]) {
    for (int c = 0; c < 2; ++c) {
        for (int n = 0; n < 3; ++n) {
            float sums[4] = {};
            for (int k = 0; k < 16; ++k) sums[k % 4] += basis[n][k] * texels.value[c][k];
            coarse[3 * c + n] = (sums[0] + sums[2]) + (sums[1] + sums[3]);
        }
    }
}

AstcCopyTexels searched_texels(const float basis[3][16], const RdoRgbTexels& texels) {
    AstcCopyTexels found{16.0f, {}, 0.0f, 0.0f, 0.0f, {}};
    coarse_numbers_of(basis, texels, found.coarse);
    for (int c = 0; c < 2; ++c) {
        for (const float value : texels.value[c]) found.mean[c] += 1.0f / 16.0f * value;
    }
    for (int k = 0; k < 16; ++k) {
        const float x = texels.value[0][k] - found.mean[0], y = texels.value[1][k] - found.mean[1];
        found.xx += x * x;
        found.xy += x * y;
        found.yy += y * y;
    }
    return found;
}

}  // namespace

RdoRgbSources::RdoRgbSources(int window, std::size_t most) : reach_(std::max(1, window / kRgbBytes)) {
    // The mean and both slopes.
    float squares[3] = {};
    for (int k = 0; k < 16; ++k) {
        basis_[0][k] = 1.0f;
        basis_[1][k] = static_cast<float>(2 * (k % 4) - 3);
        basis_[2][k] = static_cast<float>(2 * (k / 4) - 3);
        for (int n = 0; n < 3; ++n) squares[n] += basis_[n][k] * basis_[n][k];
    }
    for (int n = 0; n < 3; ++n) {
        for (int k = 0; k < 16; ++k) basis_[n][k] /= std::sqrt(squares[n]);
    }
    for (std::vector<float>& column : coarse_) column.resize(most + kRgbVectorSlack);
    for (std::vector<float>* column :
         {&cos_, &sin_, &middle_[0], &middle_[1], &half_[0], &half_[1], &noise_, &literals_})
        column->resize(most + kRgbVectorSlack);
    decoded_.reserve(most);
    entries_.reserve(most);
    const auto farthest = static_cast<std::size_t>(std::min(reach_, static_cast<int>(most)));
    prices_.resize(farthest + kRgbVectorSlack);
    whole_costs_.resize(farthest + kRgbVectorSlack);
    front_costs_.resize(farthest + kRgbVectorSlack);
}

void RdoRgbSources::set_lambda(float lambda) {
    lambda_ = lambda;
    const std::size_t farthest = prices_.size() - kRgbVectorSlack;
    for (std::size_t k = 0; k < farthest; ++k)
        prices_[k] = lambda * match_bits(static_cast<int>(kRgbBytes * (farthest - k)));
}

AstcCopyTable RdoRgbSources::table(std::size_t first) const {
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

// Where the entries of a subset lie. In two planes, they fill a rectangle.
void RdoRgbSources::add_line(const RdoRgbEntries& entries) {
    const std::size_t at = count_;
    const BlockEntries& block = entries.block;
    literals_[at] = static_cast<float>(kRgbBytes - block.front_bytes());
    noise_[at] = kNoRgbLine;
    cos_[at] = 1.0f;
    if (block.subsets > 1) return;
    const int last[2] = {(1 << block.bits[0]) - 1, ((1 << block.bits[1]) - 1) << block.bits[0]};
    float step[2][2], middle[2];  // by plane and component
    for (int c = 0; c < 2; ++c) {
        const float* const value = entries.value[c];
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
    const float length = std::sqrt(squares[along]);
    const float cos = length > 0.0f ? step[along][0] / length : 1.0f;
    const float sin = length > 0.0f ? step[along][1] / length : 0.0f;
    cos_[at] = cos;
    sin_[at] = sin;
    middle_[0][at] = cos * middle[0] + sin * middle[1];
    middle_[1][at] = cos * middle[1] - sin * middle[0];
    half_[0][at] = 0.5f * (length + std::fabs(cos * step[1 - along][0] + sin * step[1 - along][1]));
    half_[1][at] = 0.5f * std::fabs(cos * step[1 - along][1] - sin * step[1 - along][0]);
    noise_[at] = noise;
}

void RdoRgbSources::add(const RdoRgbEntries& entries, const RdoRgbTexels& decoded) {
    float coarse[kAstcCoarse];
    coarse_numbers_of(basis_, decoded, coarse);
    for (std::size_t n = 0; n < kAstcCoarse; ++n) coarse_[n][count_] = coarse[n];
    decoded_.push_back(decoded);
    entries_.push_back(entries);
    add_line(entries);
    ++count_;
}

float RdoRgbSources::squared_distance(const RdoRgbBlock& block, int at) const {
    float squares[16], sums[4] = {};
    squared_distances(block.texels.value, decoded(at).value, squares);
    for (int k = 0; k < 16; ++k) sums[k % 4] += squares[k];
    return (sums[0] + sums[2]) + (sums[1] + sums[3]);
}

void RdoRgbSources::find(const RdoRgbSearcher& searcher) {
    constexpr int kMostWholes = 4, kMostFronts = 16;
    // Estimates err: so what seems to cost a little more than the block as it is is still tried.
    constexpr float kOverPlain = 2.0f;
    const int first = std::max(0, searcher.number - reach_);
    const int count = searcher.number - first;
    const float* const prices = prices_.data() + (prices_.size() - kRgbVectorSlack - static_cast<std::size_t>(count));
    astc_copy_costs(table(static_cast<std::size_t>(first)), searched_texels(basis_, searcher.block->texels), prices,
                    searcher.scale, lambda_ * kUsualLiteral, count, whole_costs_.data(), front_costs_.data());
    // Among equal costs, the later block comes first.
    CheapCopies wholes(kOverPlain * searcher.cost, kMostWholes), fronts(kOverPlain * searcher.cost, kMostFronts);
    for (int k = count - 1; k >= 0; --k) {
        const auto at = static_cast<std::size_t>(k);
        if (front_costs_[at] < fronts.bound()) fronts.add({front_costs_[at], first + k, 0});
        if (whole_costs_[at] >= wholes.bound()) continue;
        const float length = std::sqrt(squared_distance(*searcher.block, first + k));
        wholes.add({0.9f * 4.0f * 57.29578f * length + prices[k], first + k, 0});
    }
    wholes_.clear();
    for (const CheapCopy& copy : wholes) wholes_.push_back(copy.at);
    fronts_.clear();
    for (const CheapCopy& copy : fronts) fronts_.push_back(copy.at);
}

}  // namespace tex::inline v1
