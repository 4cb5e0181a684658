// SPDX-License-Identifier: Apache-2.0

#include "preview/colormap.h"

#include <algorithm>
#include <array>

namespace tex::inline v1::render {
namespace {

constexpr Vec3 kMagenta{1.0, 0.0, 1.0};

double unit(double value) { return value > 0.0 ? std::min(value, 1.0) : 0.0; }

}  // namespace

Vec3 viridis(double t) {
    constexpr Vec3 kFit[] = {
        {0.2777273272234177, 0.005407344544966578, 0.3340998053353061},
        {0.1050930431085774, 1.404613529898575, 1.384590162594685},
        {-0.3308618287255563, 0.214847559468213, 0.09509516302823659},
        {-4.634230498983486, -5.799100973351585, -19.33244095627987},
        {6.228269936347081, 14.17993336680509, 56.69055260068105},
        {4.776384997670288, -13.74514537774601, -65.35303263337234},
        {-5.435455855934631, 4.645852612178535, 26.3124352495832},
    };
    if (t != t) return kMagenta;
    t = unit(t);
    Vec3 color = kFit[6];
    for (int k = 5; k >= 0; --k) color = kFit[k] + color * t;
    return {unit(color.x), unit(color.y), unit(color.z)};
}

Vec3 diverging(double t) {
    constexpr Vec3 kStops[] = {
        {0.06, 0.20, 0.42}, {0.36, 0.61, 0.83}, {0.97, 0.97, 0.96}, {0.94, 0.64, 0.34}, {0.48, 0.19, 0.02},
    };
    if (t != t) return kMagenta;
    const double place = (std::clamp(t, -1.0, 1.0) + 1.0) * 2.0;
    const int k = std::min(static_cast<int>(place), 3);
    return kStops[k] + (kStops[k + 1] - kStops[k]) * (place - k);
}

Vec3 inferno(double t) {
    constexpr std::uint32_t kStops[] = {0x000004, 0x1b0c42, 0x4b0c6b, 0x781c6d, 0xa52c60,
                                        0xcf4446, 0xed6925, 0xfb9a06, 0xf7d03c, 0xfcffa4};
    constexpr int kPieces = 9;
    const auto stop = [&](int k) {
        const auto channel = [&](int shift) { return static_cast<double>(kStops[k] >> shift & 0xff) / 255.0; };
        return Vec3{channel(16), channel(8), channel(0)};
    };
    if (t != t) return kMagenta;
    const double place = unit(t) * kPieces;
    const int k = std::min(static_cast<int>(place), kPieces - 1);
    return stop(k) + (stop(k + 1) - stop(k)) * (place - k);
}

std::uint8_t display_code(double value) { return static_cast<std::uint8_t>(unit(value) * 255.0 + 0.5); }

double srgb_to_linear(double value) {
    return value <= 0.04045 ? value / 12.92 : math::pow((value + 0.055) / 1.055, 2.4);
}

std::uint8_t srgb_code(double linear) {
    // Code k begins at the sRGB value (k - 0.5) / 255. A search needs no curve for each pixel and rounds exactly.
    static const std::array<double, 255> kBegins = [] {
        std::array<double, 255> begins{};
        for (std::size_t k = 0; k < begins.size(); ++k)
            begins[k] = srgb_to_linear((static_cast<double>(k) + 0.5) / 255.0);
        return begins;
    }();
    if (linear != linear) return 0;
    return static_cast<std::uint8_t>(std::upper_bound(kBegins.begin(), kBegins.end(), linear) - kBegins.begin());
}

}  // namespace tex::inline v1::render
