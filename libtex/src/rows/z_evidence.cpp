// SPDX-License-Identifier: Apache-2.0

#include "rows/z_evidence.h"

#include <cmath>

namespace tex::inline v1 {
namespace {

constexpr int kZTexels = 256;  // of a row, about

}  // namespace

void ZEvidence::add_row(const float* x, const float* y, const float* z, bool is_unsigned, int width) {
    constexpr float kOne = 1024.0f, kNoDirection = 0.25f;
    const float scale = is_unsigned ? 2.0f : 1.0f, offset = is_unsigned ? 1.0f : 0.0f;
    for (int i = 0; i < width; i += std::max(1, width / kZTexels)) {
        const float a = x[i] * scale - offset, b = y[i] * scale - offset, c = z[i] * scale - offset;
        const float across = a * a + b * b;
        if (across > 1.0f) ++beyond_;
        if (across > 1.0f || across + c * c < kNoDirection) continue;  // background
        const auto stored = static_cast<std::int64_t>(std::lround(std::abs(c) * kOne));
        const auto rebuilt = static_cast<std::int64_t>(std::lround(std::sqrt(1.0f - across) * kOne));
        ++count_;
        off_ += std::abs(stored - rebuilt);
        z_ += stored;
        rebuilt_ += rebuilt;
        z_square_ += stored * stored;
        rebuilt_square_ += rebuilt * rebuilt;
        product_ += stored * rebuilt;
    }
}

double ZEvidence::beyond() const {
    return static_cast<double>(beyond_) / static_cast<double>(std::max<std::int64_t>(1, beyond_ + count_));
}

void ZEvidence::add(const ZEvidence& other) {
    beyond_ += other.beyond_;
    count_ += other.count_;
    off_ += other.off_;
    z_ += other.z_;
    rebuilt_ += other.rebuilt_;
    z_square_ += other.z_square_;
    rebuilt_square_ += other.rebuilt_square_;
    product_ += other.product_;
}

bool ZEvidence::is_something_else() const {
    constexpr std::int64_t kLeastTexels = 1024;
    constexpr double kOff = 0.03 * 1024, kVaries = 0.005 * 1024, kFollows = 0.7;
    if (count_ < kLeastTexels) return false;
    const auto n = static_cast<double>(count_);
    const auto mean = [n](std::int64_t sum) { return static_cast<double>(sum) / n; };
    const double stored = mean(z_square_) - mean(z_) * mean(z_);
    const double rebuilt = mean(rebuilt_square_) - mean(rebuilt_) * mean(rebuilt_);
    if (mean(off_) < kOff || rebuilt < kVaries * kVaries) return false;
    const double both = mean(product_) - mean(z_) * mean(rebuilt_);
    return both < kFollows * std::sqrt(std::max(stored, 0.0) * rebuilt) || !(stored > 0.0);
}

}  // namespace tex::inline v1
