// SPDX-License-Identifier: Apache-2.0

#include "rows/blue_evidence.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace tex::inline v1 {
namespace {

constexpr float kNearOne = 1.0f - 8.0f / 255.0f;    // a BC1 block may miss 1 by this much
constexpr float kTilted = 0.01f, kUpright = 0.98f;  // x^2 + y^2: nearly flat texels look alike either way
constexpr std::int64_t kFewTilted = 256, kManyTilted = 4096;

double off_unit(float across, float z) { return static_cast<double>(std::min(std::abs(across + z * z - 1.0f), 1.0f)); }

}  // namespace

void BlueEvidence::add_row(const float* const (&channels)[4], int width) {
    for (std::size_t c = 0; c < std::size(channels); ++c) {
        if (channels[c] != nullptr)
            least_[c] = std::min(least_[c], *std::min_element(channels[c], channels[c] + width));
    }
    greatest_green_ = std::max(greatest_green_, *std::max_element(channels[1], channels[1] + width));
    for (int i = 0; i < width; ++i) {
        const float x = 2.0f * channels[0][i] - 1.0f, y = 2.0f * channels[1][i] - 1.0f, b = channels[2][i];
        const float across = x * x + y * y;
        if (!(across >= kTilted && across <= kUpright)) continue;
        ++tilted_;
        off_z01_ += off_unit(across, b);
        off_usual_ += off_unit(across, 2.0f * b - 1.0f);
    }
}

bool BlueEvidence::is_certain() const {
    constexpr double kUsual = 0.3;
    const bool has_x = least_[0] < kNearOne || least_[2] < kNearOne || least_[3] < kNearOne;
    return has_x && tilted_ >= kManyTilted && off_z01_ > kUsual * off_usual_;
}

bool BlueEvidence::lacks_x() const {
    return least_[0] >= kNearOne && least_[2] >= kNearOne && least_[3] >= kNearOne &&
           greatest_green_ - least_[1] > 1.0f - kNearOne;
}

bool BlueEvidence::is_z01() const {
    constexpr double kRatio = 0.15, kMostOff = 0.03, kLeastOff = 0.05;
    if (tilted_ < kFewTilted) return false;
    const auto count = static_cast<double>(tilted_);
    return off_z01_ < kRatio * off_usual_ && off_z01_ < kMostOff * count && off_usual_ > kLeastOff * count;
}

}  // namespace tex::inline v1
