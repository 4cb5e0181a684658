// SPDX-License-Identifier: Apache-2.0

#include "reference/blend.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "reference/scale.h"

namespace tex::reference {
namespace {

double overlay(double base, double detail) {
    const double a = (base + 1) / 2;
    const double b = (detail + 1) / 2;
    return 2 * (a < 0.5 ? 2 * a * b : 1 - 2 * (1 - a) * (1 - b)) - 1;
}

Vector raw_blend(Vector a, Vector b, BlendMode mode) {
    switch (mode) {
        case BlendMode::whiteout: return {a.x + b.x, a.y + b.y, a.z * b.z};
        case BlendMode::linear: return {a.x + b.x, a.y + b.y, a.z + b.z};
        case BlendMode::partial_derivative: return {a.x * b.z + b.x * a.z, a.y * b.z + b.y * a.z, a.z * b.z};
        case BlendMode::udn: return {a.x + b.x, a.y + b.y, a.z};
        case BlendMode::rnm: {
            const Vector t{a.x, a.y, a.z + 1};
            const Vector u{-b.x, -b.y, b.z};
            const double f = (t.x * u.x + t.y * u.y + t.z * u.z) / t.z;
            return {t.x * f - u.x, t.y * f - u.y, t.z * f - u.z};
        }
        case BlendMode::overlay: return {overlay(a.x, b.x), overlay(a.y, b.y), overlay(a.z, b.z)};
    }
    return {};
}

int wrapped(Wrap wrap, int i, int n) {
    if (wrap == Wrap::clamp) return std::clamp(i, 0, n - 1);
    if (wrap == Wrap::repeat) return ((i % n) + n) % n;
    const int k = ((i % (2 * n)) + 2 * n) % (2 * n);
    return k < n ? k : 2 * n - 1 - k;
}

Vector lerp(Vector a, Vector b, double t) {
    return {a.x + (b.x - a.x) * t, a.y + (b.y - a.y) * t, a.z + (b.z - a.z) * t};
}

}  // namespace

Vector blended(Vector base, Vector detail, BlendMode mode) {
    Vector n = raw_blend(base, detail, mode);
    n.z = std::max(n.z, 0.0);
    return normalised(n);
}

Vector bilinear(const Grid<Vector>& map, double u, double v, Wrap wrap_x, Wrap wrap_y) {
    const double s = u * map.extent.width - 0.5;
    const double t = (1 - v) * map.extent.height - 0.5;
    const int i = static_cast<int>(std::floor(s));
    const int j = static_cast<int>(std::floor(t));
    const auto texel = [&](int di, int dj) {
        return map.at(wrapped(wrap_x, i + di, map.extent.width), wrapped(wrap_y, j + dj, map.extent.height));
    };
    return lerp(lerp(texel(0, 0), texel(1, 0), s - i), lerp(texel(0, 1), texel(1, 1), s - i), t - j);
}

Grid<Vector> blend(const Grid<Vector>& base, const std::vector<Grid<Vector>>& detail, const Layer& layer,
                   const BlendOptions& options) {
    const double width = base.extent.width;
    const double height = base.extent.height;
    const double angle = static_cast<double>(layer.rotation) * std::numbers::pi / 180;
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    const auto place = [&](double x, double y) {  // texels from the middle, y upwards
        const double turned_x = c * x + s * y;
        const double turned_y = c * y - s * x;
        return Vector{
            (turned_x / width + 0.5) * static_cast<double>(layer.tiling_x) + static_cast<double>(layer.offset_x),
            (turned_y / height + 0.5) * static_cast<double>(layer.tiling_y) + static_cast<double>(layer.offset_y), 0};
    };
    // The level, from the distance that a step of one texel makes in the detail.
    const auto step = [&](double x, double y) {
        const Vector from = place(0, 0);
        const Vector to = place(x, y);
        return std::hypot((to.x - from.x) * detail[0].extent.width, (to.y - from.y) * detail[0].extent.height);
    };
    const double level =
        std::clamp(std::log2(std::max(step(1, 0), step(0, 1))), 0.0, static_cast<double>(detail.size() - 1));
    const auto lower = static_cast<std::size_t>(level);
    const std::size_t upper = std::min(lower + 1, detail.size() - 1);

    // The mask covers the result; its values are kept in x.
    Grid<Vector> mask({1, 1});
    mask.at(0, 0).x = 1;
    if (!layer.mask.empty()) {
        mask = Grid<Vector>(layer.mask.extent());
        for (int j = 0; j < mask.extent.height; ++j) {
            for (int i = 0; i < mask.extent.width; ++i) mask.at(i, j).x = static_cast<double>(layer.mask.at(i, j));
        }
    }
    Grid<Vector> result(base.extent);
    for (int j = 0; j < base.extent.height; ++j) {
        for (int i = 0; i < base.extent.width; ++i) {
            const Vector a = scaled(base.at(i, j), static_cast<double>(options.base_scale), options.scale_mode);
            const Vector at = place(i + 0.5 - width / 2, height / 2 - j - 0.5);
            Vector b = lerp(bilinear(detail[lower], at.x, at.y, layer.wrap_x, layer.wrap_y),
                            bilinear(detail[upper], at.x, at.y, layer.wrap_x, layer.wrap_y),
                            level - static_cast<double>(lower));
            b = scaled(normalised(b), static_cast<double>(layer.scale), options.scale_mode);
            b = {c * b.x - s * b.y, s * b.x + c * b.y, b.z};
            const double shown = bilinear(mask, (i + 0.5) / width, 1 - (j + 0.5) / height, Wrap::clamp, Wrap::clamp).x;
            const double weight = static_cast<double>(layer.strength) * std::clamp(shown, 0.0, 1.0);
            result.at(i, j) = normalised(lerp(a, blended(a, b, options.mode), weight));
        }
    }
    return result;
}

}  // namespace tex::reference
