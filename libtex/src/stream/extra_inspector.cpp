// SPDX-License-Identifier: Apache-2.0

#include "stream/extra_inspector.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "rows/extra_rows.h"

namespace tex::inline v1 {
namespace {

constexpr float kVaries = 1.5f / 255.0f;

}  // namespace

ExtraInspector::ExtraInspector(const Texture& head, Extent extent, const Sources& sources, const SourceOptions& options)
    : sources_(sources), is_floating_(format_info(head.format).sample == SampleKind::floating),
      judges_z_(!options.drop_others && !options.unpack.others.length && sources.z >= 0 && !is_floating_ &&
                options.unpack.range != ValueRange::z01),
      is_unsigned_(format_info(head.format).sample == SampleKind::unorm), z_step_(z_step(extent.height)),
      lengths_(!options.drop_others && options.unpack.others.length && sources.z >= 0) {
    if (options.drop_others) return;
    constexpr float kNone = std::numeric_limits<float>::infinity();
    for (int c = 0; c < format_info(head.format).channels; ++c) {
        const bool is_stated = head.swizzle_known && head.swizzle[static_cast<std::size_t>(c)] == Component::one;
        const bool is_source = c == sources.x || c == sources.y || c == sources.z;
        if (!is_source && (c == channel_of(Extra::alpha) || !is_stated))
            seen_.push_back({c, kNone, -kNone, 0.0f, 0.0f, 0.0f});
    }
}

bool ExtraInspector::wants(int channel) const {
    return std::any_of(seen_.begin(), seen_.end(), [channel](const Seen& seen) { return seen.channel == channel; });
}

void ExtraInspector::look(Seen& seen, const float* const (&channels)[4], const VectorRow& normals, int width) const {
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

void ExtraInspector::count_not_finite(const float* const (&channels)[4], int width) {
    const float *const x = channels[sources_.x], *const y = channels[sources_.y];
    const float* const z = sources_.z < 0 ? y : channels[sources_.z];
    int count = 0;
    for (int i = 0; i < width; ++i) count += 0.0f * x[i] + 0.0f * y[i] + 0.0f * z[i] == 0.0f ? 0 : 1;
    if (count > 0) not_finite_ += count;
}

void ExtraInspector::look_at_lengths(const float* const (&channels)[4], int width) {
    Plane<float> row(Extent{width, 1});
    values_of_lengths(channels[sources_.x], channels[sources_.y], channels[sources_.z], is_unsigned_, width,
                      row.row(0));
    const auto [least, greatest] = std::minmax_element(row.row(0), row.row(0) + width);
    const std::lock_guard lock(mutex_);
    shortest_ = std::min(shortest_, *least);
    longest_ = std::max(longest_, *greatest);
}

void ExtraInspector::add_row(int j, const float* const (&channels)[4], const VectorRow& normals, int width) {
    if (judges_z_ && j % z_step_ == 0) {
        ZEvidence z;
        z.add_row(channels[sources_.x], channels[sources_.y], channels[sources_.z], is_unsigned_, width);
        const std::lock_guard lock(mutex_);
        z_.add(z);
    }
    if (is_floating_) count_not_finite(channels, width);
    if (lengths_) look_at_lengths(channels, width);
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

std::vector<ExtraChannel> ExtraInspector::found() const {
    std::vector<ExtraChannel> found;
    for (const Seen& seen : seen_) {
        const bool repeats = std::min({seen.off_x, seen.off_y, seen.off_z}) <= kSameInBlocks;
        if (seen.greatest - seen.least > kVaries && !repeats)
            found.push_back({"RGBA"[seen.channel], seen.least, seen.greatest});
    }
    if (longest_ - shortest_ > kVaries) found.push_back({'L', shortest_, longest_});
    return found;
}

std::vector<ExtraChannel> ExtraInspector::report(SourceInfo& info) const {
    info.z_doubtful = z_.is_something_else() || z_.is_surely_something_else();
    info.not_finite = not_finite_;
    return found();
}

std::vector<ExtraChannel> left_out(std::vector<ExtraChannel> channels, ExtraSet accounted_for) {
    std::erase_if(channels, [&](const ExtraChannel& channel) { return channel.is_in(accounted_for); });
    return channels;
}

}  // namespace tex::inline v1
