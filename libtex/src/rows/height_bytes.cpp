// SPDX-License-Identifier: Apache-2.0

#include "rows/height_bytes.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

namespace tex::inline v1 {
namespace {

// Metres. No place on the Earth is lower or higher.
constexpr double kLowest = -12000.0, kHighest = 9000.0;

// The code of a value; values of other pictures than those of 8 bits stay what they are.
double code_of_value(float value, bool has_numbers) {
    return has_numbers ? static_cast<double>(value) : std::floor(static_cast<double>(value) * 255.0 + 0.5);
}

bool has_two_bytes(HeightChannel channel) { return channel == HeightChannel::rg16 || channel == HeightChannel::gr16; }

// The distance between two codes of a byte; values that are no codes count as 0.
std::int64_t step_between(double a, double b) {
    const double distance = std::abs(a - b);
    return distance <= 255.0 ? static_cast<std::int64_t>(distance) : 0;
}

}  // namespace

double height_of_bytes(double r, double g, double b, HeightChannel channel, bool has_numbers) {
    if (channel == HeightChannel::terrain_rgb) return -10000.0 + 0.1 * (65536.0 * r + 256.0 * g + b);
    if (channel == HeightChannel::terrarium) return 256.0 * r + g + b / 256.0 - 32768.0;
    return (channel == HeightChannel::gr16 ? 256.0 * g + r : 256.0 * r + g) / (has_numbers ? 1.0 : 65535.0);
}

bool is_on_earth(double height) { return height >= kLowest && height <= kHighest; }

HeightCounts height_bytes_row(const ColorRow& in, const float* alpha, HeightChannel channel, bool has_numbers,
                              int count, float* out) {
    HeightCounts counts;
    double last_r = 0.0, last_g = 0.0;
    for (int i = 0; i < count; ++i) {
        if (alpha != nullptr && alpha[i] == 0.0f) {
            out[i] = std::numeric_limits<float>::quiet_NaN();
            continue;
        }
        const double r = code_of_value(in.r[i], has_numbers);
        const double g = code_of_value(in.g[i], has_numbers);
        const double b = code_of_value(in.b[i], has_numbers);
        const double height = height_of_bytes(r, g, b, channel, has_numbers);
        const bool odd = has_two_bytes(channel) ? r == g : !is_on_earth(height);
        counts.implausible += odd ? 1 : 0;
        out[i] = static_cast<float>(height);
        if (i > 0) {
            counts.red_steps += step_between(r, last_r);
            counts.green_steps += step_between(g, last_g);
        }
        last_r = r;
        last_g = g;
    }
    return counts;
}

std::optional<Error> exchanged_bytes(const HeightCounts& counts, HeightChannel channel) {
    if (!has_two_bytes(channel)) return std::nullopt;
    constexpr std::int64_t kClearly = 2, kLeast = 256;
    const bool is_rg = channel == HeightChannel::rg16;
    const std::int64_t high = is_rg ? counts.red_steps : counts.green_steps;
    const std::int64_t low = is_rg ? counts.green_steps : counts.red_steps;
    // A low byte that is the same everywhere is that of 8 bits.
    if (low == 0 || high < kLeast || high <= kClearly * low) return std::nullopt;
    const std::string low_name = is_rg ? "green" : "red", high_name = is_rg ? "red" : "green";
    return Error{ErrorCode::bad_data,
                 {},
                 "the heights are not " + std::string(name_of(kHeightChannelNames, channel)) + ": " + high_name +
                     ", their high byte, varies more from texel to texel than " + low_name + "; " +
                     (is_rg ? "gr16" : "rg16") + " takes " + high_name + " as the low byte"};
}

}  // namespace tex::inline v1
