// SPDX-License-Identifier: Apache-2.0

#include "rows/rdo_copies.h"

#include <algorithm>

#include "rows/rdo_rate.h"

namespace tex::inline v1 {
namespace {

constexpr std::size_t kVectorSlack = 32;  // kernels read and write whole vectors

}  // namespace

void RdoLine::set(const float center[2], const float step[2], const float other[2], float rounding) {
    const float length = std::sqrt(step[0] * step[0] + step[1] * step[1]);
    if (length > 0.0f) {
        cos = step[0] / length;
        sin = step[1] / length;
    }
    middle[0] = cos * center[0] + sin * center[1];
    middle[1] = cos * center[1] - sin * center[0];
    half[0] = 0.5f * (length + std::fabs(cos * other[0] + sin * other[1]));
    half[1] = 0.5f * std::fabs(cos * other[1] - sin * other[0]);
    noise = rounding;
}

RdoCopies::RdoCopies(Extent block, int window, std::size_t most)
    : texels_(block.width * block.height), reach_(std::max(1, window / kRdoBlockBytes)) {
    // The mean and both slopes.
    for (std::vector<float>& numbers : basis_) numbers.resize(static_cast<std::size_t>(texels_));
    for (int k = 0; k < texels_; ++k) {
        const auto at = static_cast<std::size_t>(k);
        basis_[0][at] = 1.0f;
        basis_[1][at] = static_cast<float>(2 * (k % block.width) - (block.width - 1));
        basis_[2][at] = static_cast<float>(2 * (k / block.width) - (block.height - 1));
    }
    for (std::vector<float>& numbers : basis_) {
        float squares = 0.0f;
        for (const float number : numbers) squares += number * number;
        for (float& number : numbers) number /= std::sqrt(squares);
    }
    for (std::vector<float>& column : coarse_) column.resize(most + kVectorSlack);
    for (std::vector<float>* column :
         {&cos_, &sin_, &middle_[0], &middle_[1], &half_[0], &half_[1], &noise_, &literals_})
        column->resize(most + kVectorSlack);
    const std::size_t farthest = std::min(static_cast<std::size_t>(reach_), most) + kVectorSlack;
    for (std::vector<float>* column : {&prices_, &whole_costs_, &front_costs_}) column->resize(farthest);
}

void RdoCopies::set_lambda(float lambda) {
    lambda_ = lambda;
    const std::size_t farthest = prices_.size() - kVectorSlack;
    for (std::size_t k = 0; k < farthest; ++k)
        prices_[k] = lambda * match_bits(static_cast<int>(kRdoBlockBytes * (farthest - k)));
}

AstcCopyTable RdoCopies::table(std::size_t first) const {
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

void RdoCopies::find_coarse(const float* x, const float* y, float coarse[kAstcCoarse]) const {
    for (const float* const values : {x, y}) {
        for (const std::vector<float>& numbers : basis_) {
            float sums[4] = {};
            for (int k = 0; k < texels_; ++k) sums[k % 4] += numbers[static_cast<std::size_t>(k)] * values[k];
            *coarse++ = (sums[0] + sums[2]) + (sums[1] + sums[3]);
        }
    }
}

void RdoCopies::add(const float* x, const float* y, const RdoLine& line) {
    float coarse[kAstcCoarse];
    find_coarse(x, y, coarse);
    for (std::size_t n = 0; n < kAstcCoarse; ++n) coarse_[n][count_] = coarse[n];
    cos_[count_] = line.cos;
    sin_[count_] = line.sin;
    for (int n = 0; n < 2; ++n) {
        middle_[n][count_] = line.middle[n];
        half_[n][count_] = line.half[n];
    }
    noise_[count_] = line.noise;
    literals_[count_] = line.literals;
    ++count_;
}

const float* RdoCopies::score(const RdoSearched& block, int first) {
    AstcCopyTexels texels{static_cast<float>(texels_), {}, 0.0f, 0.0f, 0.0f, {}};
    find_coarse(block.x, block.y, texels.coarse);
    const float over = 1.0f / texels.texels;
    for (int k = 0; k < texels_; ++k) {
        texels.mean[0] += over * block.x[k];
        texels.mean[1] += over * block.y[k];
    }
    for (int k = 0; k < texels_; ++k) {
        const float x = block.x[k] - texels.mean[0], y = block.y[k] - texels.mean[1];
        texels.xx += x * x;
        texels.xy += x * y;
        texels.yy += y * y;
    }
    const int count = block.number - first;
    const float* const prices = prices_.data() + (prices_.size() - kVectorSlack - static_cast<std::size_t>(count));
    astc_copy_costs(table(static_cast<std::size_t>(first)), texels, prices, block.scale, lambda_ * kUsualLiteral, count,
                    whole_costs_.data(), front_costs_.data());
    return prices;
}

void RdoCopies::take(const CheapCopies& from, std::vector<int>& to) {
    to.clear();
    for (const CheapCopy& copy : from) to.push_back(copy.at);
}

}  // namespace tex::inline v1
