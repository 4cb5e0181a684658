// SPDX-License-Identifier: Apache-2.0

#include "stream/other_channels.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace tex {
namespace {

constexpr float kVaries = 1.5f / 255.0f;
constexpr int kZRows = 64;                 // whose z is judged, about
constexpr int kZTexels = 256;              // of such a row, about
constexpr float kRepeats = 8.5f / 255.0f;  // the same value in channels of 5 and 6 bits, and rebuilt z, differ by less

}  // namespace

void ZEvidence::add_row(const float* x, const float* y, const float* z, bool is_unsigned, int width) {
    constexpr float kOne = 1024.0f, kNoDirection = 0.25f;
    const float scale = is_unsigned ? 2.0f : 1.0f, offset = is_unsigned ? 1.0f : 0.0f;
    for (int i = 0; i < width; i += std::max(1, width / kZTexels)) {
        const float a = x[i] * scale - offset, b = y[i] * scale - offset, c = z[i] * scale - offset;
        const float across = a * a + b * b;
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

void ZEvidence::add(const ZEvidence& other) {
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

OtherChannels::OtherChannels(const Texture& head, Extent extent, const Sources& sources)
    : sources_(sources), judges_z_(sources.z >= 0 && format_info(head.format).sample != SampleKind::floating),
      is_unsigned_(format_info(head.format).sample == SampleKind::unorm), z_step_(std::max(1, extent.height / kZRows)) {
    constexpr float kNone = std::numeric_limits<float>::infinity();
    constexpr int kAlpha = 3;
    for (int c = 0; c < format_info(head.format).channels; ++c) {
        const bool is_stated = head.swizzle_known && head.swizzle[static_cast<std::size_t>(c)] == Component::one;
        const bool is_source = c == sources.x || c == sources.y || c == sources.z;
        if (!is_source && (c == kAlpha || !is_stated)) seen_.push_back({c, kNone, -kNone, 0.0f, 0.0f, 0.0f});
    }
}

bool OtherChannels::wants(int channel) const {
    return std::any_of(seen_.begin(), seen_.end(), [channel](const Seen& seen) { return seen.channel == channel; });
}

void OtherChannels::look(Seen& seen, const float* const (&channels)[4], const VectorRow& normals, int width) const {
    const float* const values = channels[seen.channel];
    const float *const x = channels[sources_.x], *const y = channels[sources_.y];
    // Most such channels are constant, and a constant row repeats nothing.
    const auto all_but_one = static_cast<std::size_t>(width - 1) * sizeof(float);
    if (std::memcmp(values, values + 1, all_but_one) == 0) {
        seen.least = std::min(seen.least, values[0]);
        seen.greatest = std::max(seen.greatest, values[0]);
        return;
    }
    for (int i = 0; i < width; ++i) {
        seen.least = std::min(seen.least, values[i]);
        seen.greatest = std::max(seen.greatest, values[i]);
        seen.off_x = std::max(seen.off_x, std::abs(values[i] - x[i]));
        seen.off_y = std::max(seen.off_y, std::abs(values[i] - y[i]));
        seen.off_z = std::max(seen.off_z, std::abs(values[i] - (0.5f * normals.z[i] + 0.5f)));
    }
}

void OtherChannels::add_row(int j, const float* const (&channels)[4], const VectorRow& normals, int width) {
    if (judges_z_ && j % z_step_ == 0) {
        ZEvidence z;
        z.add_row(channels[sources_.x], channels[sources_.y], channels[sources_.z], is_unsigned_, width);
        const std::lock_guard lock(mutex_);
        z_.add(z);
    }
    if (seen_.empty()) return;
    std::vector<Seen> row;
    {
        const std::lock_guard lock(mutex_);
        row = seen_;
    }
    for (Seen& seen : row) look(seen, channels, normals, width);
    const std::lock_guard lock(mutex_);
    for (std::size_t k = 0; k < row.size(); ++k) {
        seen_[k].least = std::min(seen_[k].least, row[k].least);
        seen_[k].greatest = std::max(seen_[k].greatest, row[k].greatest);
        seen_[k].off_x = std::max(seen_[k].off_x, row[k].off_x);
        seen_[k].off_y = std::max(seen_[k].off_y, row[k].off_y);
        seen_[k].off_z = std::max(seen_[k].off_z, row[k].off_z);
    }
}

std::vector<OtherChannel> OtherChannels::found() const {
    std::vector<OtherChannel> found;
    for (const Seen& seen : seen_) {
        const bool repeats = std::min({seen.off_x, seen.off_y, seen.off_z}) <= kRepeats;
        if (seen.greatest - seen.least > kVaries && !repeats)
            found.push_back({"RGBA"[seen.channel], seen.least, seen.greatest});
    }
    return found;
}

std::vector<OtherChannel> left_out(std::vector<OtherChannel> channels, OtherPlanes accounted_for) {
    std::erase_if(channels, [&](const OtherChannel& channel) {
        return (channel.name == 'A' && accounted_for.alpha) || (channel.name == 'B' && accounted_for.blue);
    });
    return channels;
}

}  // namespace tex
