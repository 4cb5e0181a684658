// SPDX-License-Identifier: Apache-2.0

#include "rows/z_evidence.h"

#include <cmath>

namespace tex::inline v1 {
namespace {

constexpr int kZTexels = 256;  // of a row, about
constexpr std::int64_t kLeastTexels = 1024;

}  // namespace

void ZEvidence::Sums::add(std::int64_t stored, std::int64_t own) {
    ++count;
    z += stored;
    rebuilt += own;
    z_square += stored * stored;
    rebuilt_square += own * own;
    product += stored * own;
}

void ZEvidence::Sums::add(const Sums& other) {
    count += other.count;
    z += other.z;
    rebuilt += other.rebuilt;
    z_square += other.z_square;
    rebuilt_square += other.rebuilt_square;
    product += other.product;
}

double ZEvidence::Sums::mean(std::int64_t sum) const { return static_cast<double>(sum) / static_cast<double>(count); }

double ZEvidence::Sums::rebuilt_variance() const { return mean(rebuilt_square) - mean(rebuilt) * mean(rebuilt); }

double ZEvidence::Sums::correlation() const {
    const double both = (mean(z_square) - mean(z) * mean(z)) * rebuilt_variance();
    return both > 0.0 ? (mean(product) - mean(z) * mean(rebuilt)) / std::sqrt(both) : 0.0;
}

void ZEvidence::add_row(const float* x, const float* y, const float* z, bool is_unsigned, int width) {
    constexpr float kOne = 1024.0f, kNoDirection = 0.01f, kShort = 0.2f, kLong = 0.25f;  // squared lengths
    constexpr std::int64_t kClearly = 31;
    const float scale = is_unsigned ? 2.0f : 1.0f, offset = is_unsigned ? 1.0f : 0.0f;
    for (int i = 0; i < width; i += std::max(1, width / kZTexels)) {
        const float a = x[i] * scale - offset, b = y[i] * scale - offset, c = z[i] * scale - offset;
        const float across = a * a + b * b, square = across + c * c;
        if (across > 1.0f) ++beyond_;
        if (across > 1.0f || square < kNoDirection) continue;  // background
        const auto stored = static_cast<std::int64_t>(std::lround(std::abs(c) * kOne));
        const auto rebuilt = static_cast<std::int64_t>(std::lround(std::sqrt(1.0f - across) * kOne));
        all_.add(stored, rebuilt);
        if (square < kShort) ++short_;
        if (stored > rebuilt + kClearly) ++over_;
        if (stored < rebuilt - kClearly) ++under_;
        if (square < kLong) continue;
        long_.add(stored, rebuilt);
        off_ += std::abs(stored - rebuilt);
    }
}

double ZEvidence::beyond() const {
    return static_cast<double>(beyond_) / static_cast<double>(std::max<std::int64_t>(1, beyond_ + long_.count));
}

void ZEvidence::add(const ZEvidence& other) {
    beyond_ += other.beyond_;
    short_ += other.short_;
    over_ += other.over_;
    under_ += other.under_;
    off_ += other.off_;
    long_.add(other.long_);
    all_.add(other.all_);
}

bool ZEvidence::is_something_else() const {
    constexpr double kOff = 0.03 * 1024, kVaries = 0.005 * 1024, kFollows = 0.7;
    constexpr double kFarOff = 0.15 * 1024, kMost = 0.5, kFollowsClosely = 0.9;
    if (long_.count < kLeastTexels) return false;
    if (long_.mean(off_) < kOff || long_.rebuilt_variance() < kVaries * kVaries) return false;
    const double correlation = long_.correlation();
    if (correlation < kFollows) return true;
    // Heights may rise where the surface is level, as z does, but not at its values.
    return long_.mean(off_) > kFarOff && all_.mean(under_) > kMost && correlation < kFollowsClosely;
}

bool ZEvidence::is_surely_something_else() const {
    constexpr double kShortShare = 0.1, kFollowsShort = 0.6;
    constexpr double kOffShare = 0.05, kFollowsOff = 0.15, kVariesMuch = 0.035 * 1024;
    if (all_.count < kLeastTexels) return false;
    const double correlation = all_.correlation();
    const auto share = [this](std::int64_t texels) { return all_.mean(texels); };
    if (share(short_) > kShortShare && correlation < kFollowsShort) return true;
    // Where z varies little, JPEG makes blue that of other texels along sharp edges, and there is nothing to follow.
    if (all_.rebuilt_variance() < kVariesMuch * kVariesMuch) return false;
    return share(over_) > kOffShare && share(under_) > kOffShare && correlation < kFollowsOff;
}

}  // namespace tex::inline v1
