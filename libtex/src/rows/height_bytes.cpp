// SPDX-License-Identifier: Apache-2.0

#include "rows/height_bytes.h"

#include <cmath>

namespace tex::inline v1 {
namespace {

// Metres. No place on the Earth is lower or higher.
constexpr double kLowest = -12000.0, kHighest = 9000.0;

// The code of a value; values of other pictures than those of 8 bits stay what they are.
double code_of_value(float value, bool has_numbers) {
    return has_numbers ? static_cast<double>(value) : std::floor(static_cast<double>(value) * 255.0 + 0.5);
}

double height_of(double r, double g, double b, HeightChannel channel, bool has_numbers) {
    if (channel == HeightChannel::terrain_rgb) return -10000.0 + 0.1 * (65536.0 * r + 256.0 * g + b);
    if (channel == HeightChannel::terrarium) return 256.0 * r + g + b / 256.0 - 32768.0;
    return (256.0 * r + g) / (has_numbers ? 1.0 : 65535.0);
}

}  // namespace

std::int64_t height_bytes_row(const ColorRow& in, HeightChannel channel, bool has_numbers, int count, float* out) {
    std::int64_t implausible = 0;
    for (int i = 0; i < count; ++i) {
        const double r = code_of_value(in.r[i], has_numbers);
        const double g = code_of_value(in.g[i], has_numbers);
        const double b = code_of_value(in.b[i], has_numbers);
        const double height = height_of(r, g, b, channel, has_numbers);
        const bool odd = channel == HeightChannel::rg16 ? r == g : height < kLowest || height > kHighest;
        implausible += odd ? 1 : 0;
        out[i] = static_cast<float>(height);
    }
    return implausible;
}

}  // namespace tex::inline v1
