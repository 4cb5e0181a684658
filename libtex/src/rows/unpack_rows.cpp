// SPDX-License-Identifier: Apache-2.0

#include "rows/unpack_rows.h"

#include <algorithm>
#include <cmath>

#include "rows/extra_rows.h"

namespace tex::inline v1 {
namespace {

constexpr const char* kChannelNames[] = {"R", "G", "B", "A"};

int channel_of(const Swizzle& swizzle, Component component) {
    const auto found = std::find(swizzle.begin(), swizzle.end(), component);
    return found == swizzle.end() ? -1 : static_cast<int>(found - swizzle.begin());
}

double length_error(double x, double y, double z, bool has_z) {
    const double excess = x * x + y * y + z * z - 1.0;
    return has_z ? std::abs(excess) : std::max(0.0, excess);
}

}  // namespace

std::array<bool, 4> channels_read(const Sources& sources, ExtraSet extras) {
    std::array<bool, 4> read = {};
    for (const int c : {sources.x, sources.y, sources.z}) {
        if (c >= 0) read[static_cast<std::size_t>(c)] = true;
    }
    for (const Extra extra : kExtras) {
        if (extras[extra] && channel_of(extra) >= 0) read[static_cast<std::size_t>(channel_of(extra))] = true;
    }
    return read;
}

ExtraSet extras_beside(const Sources& sources, int channels) {
    return extras_with([&](Extra extra) {
        const int channel = channel_of(extra);
        if (channel < 0) return sources.z >= 0;
        return channels > channel && sources.x != channel && sources.y != channel && sources.z != channel;
    });
}

Result<Sources> sources_of(const Swizzle& swizzle, unsigned available) {
    const Sources sources = {channel_of(swizzle, Component::x), channel_of(swizzle, Component::y),
                             channel_of(swizzle, Component::z)};
    if (available == 1) return Error{ErrorCode::bad_option, {}, kOneChannel};
    const std::string name = to_string(swizzle);
    if (sources.x < 0) return Error{ErrorCode::bad_option, {}, "the swizzle " + name + " has no x"};
    if (sources.y < 0) return Error{ErrorCode::bad_option, {}, "the swizzle " + name + " has no y"};
    for (const int c : {sources.x, sources.y, sources.z}) {
        if (c >= 0 && (available >> c & 1) == 0) {
            return Error{ErrorCode::bad_option,
                         {},
                         "the swizzle " + name + " reads " + kChannelNames[c] + ", which is not there"};
        }
    }
    return sources;
}

ValueRange range_of(const std::string& normal_encoding, const UnpackOptions& options) {
    if (options.range != ValueRange::automatic) return options.range;
    if (normal_encoding == "signed") return ValueRange::signed_;
    if (normal_encoding == "unsigned") return ValueRange::unsigned_;
    return ValueRange::automatic;
}

std::optional<bool> is_unsigned(SampleKind sample, ValueRange range) {
    if (sample == SampleKind::unorm) return true;
    if (sample == SampleKind::snorm || range == ValueRange::signed_) return false;
    if (range == ValueRange::unsigned_ || range == ValueRange::z01) return true;
    return std::nullopt;
}

UnpackRule rule_of(const UnpackOptions& options, SampleKind sample, int bits, YAxis y_axis) {
    UnpackRule rule;
    rule.snap_flat = options.snap_flat && sample == SampleKind::unorm && bits == 8;
    rule.is_z01 = options.range == ValueRange::z01;
    rule.flip_y = y_axis == YAxis::down;
    rule.keep_length = options.keep_length;
    rule.keep_invalid = options.keep_invalid;
    rule.keep_unit = sample == SampleKind::floating && bits == 32;
    return rule;
}

RangeEvidence weigh_row(const float* x, const float* y, const float* z, int count) {
    RangeEvidence evidence;
    for (int i = 0; i < count; ++i) {
        const double nx = x[i];
        const double ny = y[i];
        const double nz = z != nullptr ? z[i] : 0.0;
        if (nx < 0.0 || ny < 0.0 || nz < 0.0) evidence.negative = true;
        const double mz = z != nullptr ? 2.0 * nz - 1.0 : 0.0;
        const double off_signed = length_error(nx, ny, nz, z != nullptr);
        const double off_unsigned = length_error(2.0 * nx - 1.0, 2.0 * ny - 1.0, mz, z != nullptr);
        if (!std::isfinite(off_signed) || !std::isfinite(off_unsigned)) continue;
        evidence.off_signed += off_signed;
        evidence.off_unsigned += off_unsigned;
    }
    return evidence;
}

}  // namespace tex::inline v1
