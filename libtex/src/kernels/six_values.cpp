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

// The texels between the extremes.
struct InnerTexels {
    double values[16];  // codes
    int count = 0;
    double least = 0.0, greatest = 0.0;
};

InnerTexels inner_texels(const BlockTexels& texels, Bc4Codes codes) {
    InnerTexels inner;
    for (const std::int32_t value : texels.values) {
        if (value == 0 || value == codes.top * kCodeUnit) continue;
        const double code = static_cast<double>(value) / kCodeUnit;
        inner.least = inner.count == 0 ? code : std::min(inner.least, code);
        inner.greatest = inner.count == 0 ? code : std::max(inner.greatest, code);
        inner.values[inner.count++] = code;
    }
    return inner;
}

// Offers the endpoints that suit texels best by least squares, if the least of them is entry i and the greatest is
// entry j, counted from the lower endpoint.
void offer_fit(const InnerTexels& inner, int i, int j, BestOfSix& found) {
    const double step = (inner.greatest - inner.least) / (j - i);
    double sx = 0.0, sxx = 0.0, sv = 0.0, sxv = 0.0;
    for (int k = 0; k < inner.count; ++k) {
        const double value = inner.values[k];
        const double x = std::floor((value - inner.least) / step + 0.5) + i;
        sx += x;
        sxx += x * x;
        sv += value;
        sxv += x * value;
    }
    const double n = inner.count;
    const double slope = (n * sxv - sx * sv) / (n * sxx - sx * sx);  // two texels at least differ in x
    const double low = (sv - slope * sx) / n;
    found.offer(static_cast<int>(std::floor(low + 0.5)), static_cast<int>(std::floor(low + 5.0 * slope + 0.5)));
}

}  // namespace

Bc4Endpoints with_six_values(const BlockTexels& texels, Bc4Codes codes, Bc4Endpoints fitted) {
    BestOfSix found(texels, codes, fitted);
    if (found.is_exact()) return fitted;
    const InnerTexels inner = inner_texels(texels, codes);
    if (inner.least >= inner.greatest) {
        const int code = static_cast<int>(inner.least);
        found.offer(code, code);
        found.offer(code, code + 1);
    } else {
        for (int i = 0; i < 5; ++i) {
            for (int j = i + 1; j < 6 && !found.is_exact(); ++j) offer_fit(inner, i, j, found);
        }
    }
    found.polish();
    return found.best();
}

}  // namespace tex::inline v1
