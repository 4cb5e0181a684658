// SPDX-License-Identifier: Apache-2.0

#include "reference/plain_fit.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace tex::reference {
namespace {

int top_of(Palette palette) { return palette == Palette::green ? 63 : palette == Palette::bc4_snorm ? 254 : 255; }

int widen(Palette palette, int code) { return palette == Palette::green ? code << 2 | code >> 4 : code; }

// p / q codes as the nearest stored code, halves up: floor(63 / 255 p / q + 1/2), or floor(p / q + 1/2).
int nearest_code(Palette palette, double p, double q) {
    const double code = palette == Palette::green ? std::floor((42 * p + 85 * q) / (170 * q))  //
                                                  : std::floor((2 * p + q) / (2 * q));
    return static_cast<int>(std::clamp(code, 0.0, 1.0 * top_of(palette)));
}

double nearest_squared(const std::vector<double>& palette, double value) {
    double least = 1e30;
    for (const double p : palette) least = std::min(least, (value - p) * (value - p));
    return least;
}

double error_of(const BlockValues& values, const std::vector<double>& palette, double limit) {
    double sum = 0;
    for (const double value : values) {
        sum += nearest_squared(palette, value);
        if (sum >= limit) break;
    }
    return sum;
}

std::vector<double> ramp(double a, double b, int steps) {
    std::vector<double> values;
    for (int k = 0; k <= steps; ++k) values.push_back((a * (steps - k) + b * k) / steps);
    return values;
}

}  // namespace

double plain_fit(const BlockValues& values, Palette palette) {
    const int steps = palette == Palette::green ? 3 : 7;
    int low = nearest_code(palette, *std::min_element(values.begin(), values.end()), 1);
    int high = nearest_code(palette, *std::max_element(values.begin(), values.end()), 1);
    double least = 1e30;
    for (int round = 0; round < 3; ++round) {
        const double a = widen(palette, low);
        const double span = widen(palette, high) - a;
        double error = 0, k1 = 0, k2 = 0, v1 = 0, kv = 0;
        for (const double value : values) {
            const double position = span > 0 ? std::floor((2 * steps * (value - a) + span) / (2 * span)) : 0;
            const double k = std::clamp(position, 0.0, 1.0 * steps);
            const double off = (steps * (value - a) - k * span) / steps;
            error += off * off;
            k1 += k, k2 += k * k, v1 += value, kv += k * value;
        }
        least = std::min(least, error);
        const double determinant = 16 * k2 - k1 * k1;
        if (determinant == 0) break;
        const double p = v1 * k2 - k1 * kv;
        low = nearest_code(palette, p, determinant);
        high = nearest_code(palette, p + steps * (16 * kv - k1 * v1), determinant);
    }
    return least;
}

double least_error(const BlockValues& values, Palette palette) {
    const int top = top_of(palette);
    double least = 1e30;
    for (int low = 0; low <= top; ++low) {
        for (int high = low; high <= top; ++high) {
            const double a = widen(palette, low);
            const double b = widen(palette, high);
            if (palette == Palette::green) {
                least = std::min(least, error_of(values, ramp(a, b, 3), least));
                continue;
            }
            if (low < high) least = std::min(least, error_of(values, ramp(a, b, 7), least));
            std::vector<double> six = ramp(a, b, 5);
            six.insert(six.end(), {0, 1.0 * top});
            least = std::min(least, error_of(values, six, least));
        }
    }
    return least;
}

}  // namespace tex::reference
