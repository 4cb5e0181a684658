// SPDX-License-Identifier: Apache-2.0

#include "kernels/six_values.h"

#include <algorithm>
#include <cmath>

namespace tex::inline v1 {
namespace {

// Texels are rounded to kCodeUnit parts of a code, which is an error of at most so much.
constexpr std::int64_t kRoundingError = 16 * (kBc4ErrorUnit / kCodeUnit) * (kBc4ErrorUnit / kCodeUnit) / 4;

class BestOfSix {
public:
    BestOfSix(const BlockTexels& texels, Bc4Codes codes, Bc4Endpoints fitted)
        : texels_(texels), codes_(codes), best_(fitted), least_(bc4_error(texels, codes, fitted)) {}

    [[nodiscard]] Bc4Endpoints best() const { return best_; }
    [[nodiscard]] bool is_exact() const { return least_ <= kRoundingError; }

    bool offer(int low, int high) {
        if (low < 0 || high > codes_.top || low > high) return false;
        const std::int64_t error = bc4_error(texels_, codes_, {low, high});
        if (error >= least_) return false;
        least_ = error;
        best_ = {low, high};
        return true;
    }

    // Moves the endpoints while that helps.
    void polish() {
        while (!is_exact() && best_.e0 <= best_.e1) {
            const Bc4Endpoints from = best_;
            bool is_better = false;
            for (int way = 0; way < 9; ++way)
                is_better = offer(from.e0 + way / 3 - 1, from.e1 + way % 3 - 1) || is_better;
            if (!is_better) return;
        }
    }

private:
    const BlockTexels& texels_;
    const Bc4Codes codes_;
    Bc4Endpoints best_;
    std::int64_t least_;
};

}  // namespace

Bc4Endpoints with_six_values(const BlockTexels& texels, Bc4Codes codes, Bc4Endpoints fitted) {
    BestOfSix found(texels, codes, fitted);
    if (found.is_exact()) return fitted;
    std::int32_t least = codes.top * kCodeUnit, greatest = 0;  // of the texels between the extremes
    for (const std::int32_t value : texels.values) {
        if (value == 0 || value == codes.top * kCodeUnit) continue;
        least = std::min(least, value);
        greatest = std::max(greatest, value);
    }
    const auto code = [](double value) { return static_cast<int>(std::floor(value / kCodeUnit + 0.5)); };
    if (least >= greatest) {
        found.offer(least / kCodeUnit, least / kCodeUnit);
        found.offer(least / kCodeUnit, least / kCodeUnit + 1);
    } else {
        for (int i = 0; i < 5 && !found.is_exact(); ++i) {
            for (int j = i + 1; j < 6; ++j) {
                const double step = static_cast<double>(greatest - least) / (j - i);
                found.offer(code(least - i * step), code(greatest + (5 - j) * step));
            }
        }
    }
    found.polish();
    return found.best();
}

}  // namespace tex::inline v1
