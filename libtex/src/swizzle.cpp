// SPDX-License-Identifier: Apache-2.0

#include <tex/swizzle.h>

#include <algorithm>
#include <cmath>

#include <tex/unpack.h>

#include "base/guard.h"

namespace tex {
namespace {

constexpr float kConstant = 8.0f / 255.0f;  // a BC1 block's fit of a constant may stray by this much
constexpr int kMostTexels = 1 << 20;

struct Range {
    float least = INFINITY;
    float greatest = -INFINITY;

    void add(float value) {
        if (!std::isfinite(value)) return;
        least = std::min(least, value);
        greatest = std::max(greatest, value);
    }
    [[nodiscard]] bool is_constant() const { return !(greatest - least > kConstant); }
};

// How far a vector is from unit length, read as unsigned where no texel is negative.
float length_error(float a, float b, float c, bool is_signed) {
    const float scale = is_signed ? 1.0f : 2.0f;
    const float offset = is_signed ? 0.0f : 1.0f;
    const float x = a * scale - offset;
    const float y = b * scale - offset;
    const float z = c * scale - offset;
    const float error = std::abs(x * x + y * y + z * z - 1.0f);
    return std::isfinite(error) ? std::min(error, 4.0f) : 4.0f;
}

struct Evidence {
    Range channels[4];
    double rgb_error = 0.0;  // mean over the texels
    double rxgb_error = 0.0;
    double off_grey = 0.0;  // mean of |R - G| and |B - G|
};

Evidence weigh(const Image& image) {
    const Extent extent = image.extent();
    const int step = std::max(
        1, static_cast<int>(std::ceil(std::sqrt(static_cast<double>(extent.texels()) / kMostTexels))));
    Evidence evidence;
    for (int j = 0; j < extent.height; j += step) {
        for (int i = 0; i < extent.width; i += step) {
            for (std::size_t c = 0; c < 4; ++c) evidence.channels[c].add(image.planes[c].at(i, j));
        }
    }
    const bool is_signed = std::any_of(std::begin(evidence.channels), std::end(evidence.channels),
                                       [](const Range& range) { return range.least < 0.0f; });
    std::int64_t count = 0;
    for (int j = 0; j < extent.height; j += step) {
        for (int i = 0; i < extent.width; i += step) {
            const float g = image.planes[1].at(i, j);
            const float b = image.planes[2].at(i, j);
            evidence.rgb_error +=
                static_cast<double>(length_error(image.planes[0].at(i, j), g, b, is_signed));
            evidence.rxgb_error +=
                static_cast<double>(length_error(image.planes[3].at(i, j), g, b, is_signed));
            evidence.off_grey +=
                static_cast<double>(std::abs(image.planes[0].at(i, j) - g) + std::abs(b - g)) / 2.0;
            ++count;
        }
    }
    evidence.rgb_error /= static_cast<double>(count);
    evidence.rxgb_error /= static_cast<double>(count);
    evidence.off_grey /= static_cast<double>(count);
    return evidence;
}

Swizzle named(std::string_view name) {
    return *find_by_name(kSwizzleNames, name);
}

}  // namespace

Result<Swizzle> guess_swizzle(const Texture& texture, const Execution& execution) {
    return guarded([&]() -> Result<Swizzle> {
        if (texture.swizzle_known || format_info(texture.format).channels < 4) return texture.swizzle;
        auto image = decode(texture, 0, execution);
        if (!image) return image.error();
        const Evidence evidence = weigh(*image);
        const auto& [r, g, b, a] = evidence.channels;
        constexpr double kNotUnit = 0.25;  // far beyond quantisation and filtering
        if (r.is_constant() && b.is_constant() && (!a.is_constant() || evidence.rgb_error > kNotUnit))
            return named("dxt5nm");
        constexpr double kGrey = 4.0 / 255.0;  // 5 and 6 bits of the same grey differ by so much
        if (!a.is_constant() && evidence.off_grey <= kGrey) return named("dxt5nm");
        if (r.is_constant() && !a.is_constant() && evidence.rxgb_error < evidence.rgb_error)
            return named("rxgb");
        return named("rgb");
    });
}

}  // namespace tex
