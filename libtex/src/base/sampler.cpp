// SPDX-License-Identifier: Apache-2.0

#include "base/sampler.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/border.h"

namespace tex {
namespace {

// A coordinate in widths, moved by whole periods to where its texel index is a small number. Clamped axes are the same beyond
// one width outside.
double reduce(Wrap wrap, double u) {
    switch (wrap) {
        case Wrap::repeat: return u - std::floor(u);
        case Wrap::mirror: return u - 2.0 * std::floor(u / 2.0);
        case Wrap::clamp: return std::clamp(u, -1.0, 2.0);
    }
    return u;
}

struct Neighbours {
    int first, second;
    float weight;  // of the second
};

Neighbours neighbours(Wrap wrap, double u, int n) {
    const double s = reduce(wrap, u) * n - 0.5;
    const double whole = std::floor(s);
    const int index = static_cast<int>(whole);
    return {border_index(wrap, index, n), border_index(wrap, index + 1, n), static_cast<float>(s - whole)};
}

// Exactly a at 0 and b at 1.
float mix(float a, float b, float t) { return a * (1.0f - t) + b * t; }

}  // namespace

UvMap stretch(Extent result) {
    UvMap map;
    map.ux = 1.0 / result.width;
    map.vy = 1.0 / result.height;
    return map;
}

// From the middle of the result, x to the right and y upwards in its texels, the turn by -rotation gives
// x' = c x + s y, y' = c y - s x; then u = (x' / width + 1/2) tiling + offset, and v upwards likewise.
UvMap uv_map_of(const Layer& layer, Extent result, double cosine, double sine) {
    const double width = result.width;
    const double height = result.height;
    const double scale_u = static_cast<double>(layer.tiling_x) / width;
    const double scale_v = static_cast<double>(layer.tiling_y) / height;
    UvMap map;
    map.ux = cosine * scale_u;
    map.uy = -sine * scale_u;
    map.vx = sine * scale_v;
    map.vy = cosine * scale_v;
    const double middle_u = 0.5 * static_cast<double>(layer.tiling_x) + static_cast<double>(layer.offset_x);
    const double middle_v = 1.0 - (0.5 * static_cast<double>(layer.tiling_y) + static_cast<double>(layer.offset_y));
    map.u0 = middle_u - map.ux * width / 2 - map.uy * height / 2;
    map.v0 = middle_v - map.vx * width / 2 - map.vy * height / 2;
    return map;
}

double texels_per_texel(const UvMap& map, Extent source) {
    const auto length = [&](double u, double v) {
        const double x = u * source.width;
        const double y = v * source.height;
        return std::sqrt(x * x + y * y);
    };
    return std::max(length(map.ux, map.vx), length(map.uy, map.vy));
}

Sampler::Sampler(Extent source, Extent result, const UvMap& map, Wrap wrap_x, Wrap wrap_y)
    : source_(source), result_(result), map_(map), wrap_x_(wrap_x), wrap_y_(wrap_y),
      same_(source == result && map.u0 == 0.0 && map.v0 == 0.0 && map.uy == 0.0 && map.vx == 0.0 &&
            map.ux == 1.0 / result.width && map.vy == 1.0 / result.height) {
    if (!same_) taps_.resize(static_cast<std::size_t>(result.width));
}

void Sampler::place(int j) {
    row_ = j;
    if (same_) return;
    const double y = j + 0.5;
    const bool level = map_.vx == 0.0;  // the whole row lies between two rows of the source
    Neighbours rows = neighbours(wrap_y_, map_.v0 + map_.vy * y, source_.height);
    for (int i = 0; i < result_.width; ++i) {
        const double x = i + 0.5;
        const Neighbours columns = neighbours(wrap_x_, map_.u0 + map_.ux * x + map_.uy * y, source_.width);
        if (!level) rows = neighbours(wrap_y_, map_.v0 + map_.vx * x + map_.vy * y, source_.height);
        taps_[static_cast<std::size_t>(i)] = {columns.first, columns.second, rows.first, rows.second, columns.weight, rows.weight};
    }
}

void Sampler::sample(const Plane<float>& plane, float* out) const {
    if (same_) {
        std::memcpy(out, plane.row(row_), static_cast<std::size_t>(result_.width) * sizeof(float));
        return;
    }
    for (const Tap& tap : taps_) {
        const float* upper = plane.row(tap.upper);
        const float* lower = plane.row(tap.lower);
        *out++ = mix(mix(upper[tap.left], upper[tap.right], tap.x), mix(lower[tap.left], lower[tap.right], tap.x), tap.y);
    }
}

}  // namespace tex
