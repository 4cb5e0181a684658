// SPDX-License-Identifier: Apache-2.0

#include "checks/byte_heights.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "rows/height_bytes.h"

namespace tex::inline v1 {
namespace {

constexpr int kMostTileRows = 128;
constexpr double kLeastPlausible = 0.99;  // share of texels
constexpr std::int64_t kLeastTriples = 256;

// Two bytes of one number: where the low one runs over, the high one steps. So the number bends less from texel to
// texel than it does with its low byte turned round; in colours, it makes no difference.
struct Carry {
    double bends = 0.0, turned = 0.0;

    void add(const double* high, const double* low) {
        const auto bend = [](double a, double b, double c) { return std::abs(b - 0.5 * (a + c)); };
        bends += bend(256.0 * high[0] + low[0], 256.0 * high[1] + low[1], 256.0 * high[2] + low[2]);
        turned += bend(256.0 * high[0] - low[0], 256.0 * high[1] - low[1], 256.0 * high[2] - low[2]);
    }
    // Real tiles have 0.10 to 0.27 where the ground does not rise by more than the low byte holds, and pictures
    // about 1.
    [[nodiscard]] bool shows() const { return bends < 0.6 * turned; }
};

struct ByteEvidence {
    std::int64_t texels = 0;
    std::int64_t terrain_rgb = 0, terrarium = 0;  // plausible heights
    std::int64_t usual_red = 0;                   // R is 1 or 2: heights from -3446 to 9661 m as terrain-rgb
    Carry red_green;
    double blue_steps = 0.0, green_steps = 0.0;  // from texel to texel

    void add(const double* r, const double* g, const double* b) {
        const auto is_plausible = [&](HeightChannel channel) {
            return is_on_earth(height_of_bytes(r[1], g[1], b[1], channel));
        };
        ++texels;
        terrain_rgb += is_plausible(HeightChannel::terrain_rgb) ? 1 : 0;
        terrarium += is_plausible(HeightChannel::terrarium) ? 1 : 0;
        usual_red += r[1] == 1.0 || r[1] == 2.0 ? 1 : 0;
        red_green.add(r, g);
        green_steps += std::abs(g[1] - g[0]);
        blue_steps += std::abs(b[1] - b[0]);
    }

    // The lowest byte of a height varies as noise does, and the next one does not: of 256 values, noise steps by 85 in
    // the mean. No colours have hardly any red and such a blue.
    [[nodiscard]] bool has_noisy_blue() const {
        constexpr double kNoise = 40.0, kLead = 2.0;
        return blue_steps > kNoise * static_cast<double>(texels) && blue_steps > kLead * green_steps;
    }
    [[nodiscard]] bool is_most(std::int64_t count, double share = kLeastPlausible) const {
        return static_cast<double>(count) >= share * static_cast<double>(texels);
    }
    // Pictures show in their first rows that they are no tiles.
    [[nodiscard]] bool is_hopeless() const {
        constexpr double kFew = 0.9;
        return texels >= kLeastTriples && !is_most(terrarium, kFew) &&
               !(is_most(terrain_rgb, kFew) && is_most(usual_red, kFew));
    }
};

}  // namespace

std::optional<HeightChannel> byte_heights(const Image& image) {
    constexpr std::size_t kAlpha = 3;
    const Extent extent = image.extent();
    if (image.planes.size() < kAlpha) return std::nullopt;
    const bool has_alpha = image.planes.size() > kAlpha;
    ByteEvidence evidence;
    const int step = std::max(1, extent.height / kMostTileRows);
    for (int j = 0; j < extent.height; j += step) {
        const float *const red = image.planes[0].row(j), *const green = image.planes[1].row(j),
                           *const blue = image.planes[2].row(j),
                           *const alpha = has_alpha ? image.planes[3].row(j) : nullptr;
        for (int i = 1; i + 1 < extent.width; ++i) {
            double r[3], g[3], b[3];
            bool is_clear = false;  // no data
            for (int k = 0; k < 3; ++k) {
                const int at = i - 1 + k;
                const auto code = [at](const float* row) {
                    return std::floor(static_cast<double>(row[at]) * 255.0 + 0.5);
                };
                r[k] = code(red);
                g[k] = code(green);
                b[k] = code(blue);
                is_clear |= alpha != nullptr && alpha[at] == 0.0f;
            }
            if (!is_clear) evidence.add(r, g, b);
        }
        if (evidence.is_hopeless()) return std::nullopt;
    }
    if (evidence.texels < kLeastTriples) return std::nullopt;
    if (evidence.is_most(evidence.terrarium) && evidence.red_green.shows()) return HeightChannel::terrarium;
    const bool is_low = evidence.is_most(evidence.terrain_rgb) && evidence.is_most(evidence.usual_red);
    if (is_low && (evidence.red_green.shows() || evidence.has_noisy_blue())) return HeightChannel::terrain_rgb;
    return std::nullopt;
}

}  // namespace tex::inline v1
