// SPDX-License-Identifier: Apache-2.0

#include "rows/sampler.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "rows/border.h"

namespace tex::inline v1 {
namespace {

// Interpolates; the result is exactly a at 0 and b at 1.
float mix(float a, float b, float t) { return a * (1.0f - t) + b * t; }

}  // namespace

UvMap stretch(Extent result) {
    UvMap map;
    map.ux = 1.0 / result.width;
    map.vy = 1.0 / result.height;
    return map;
}

// From the middle of the result, with x to the right and y upwards in texels of the result, the rotation by -rotation
// gives x' = c x + s y, y' = c y - s x. Then u = (x' / width + 1/2) tiling + offset, and v upwards likewise.
UvMap uv_map_of(const Placement& placement, Extent result, double cosine, double sine) {
    const double width = result.width;
    const double height = result.height;
    const double scale_u = static_cast<double>(placement.tiling_x) / width;
    const double scale_v = static_cast<double>(placement.tiling_y) / height;
    UvMap map;
    map.ux = cosine * scale_u;
    map.uy = -sine * scale_u;
    map.vx = sine * scale_v;
    map.vy = cosine * scale_v;
    const double middle_u = 0.5 * static_cast<double>(placement.tiling_x) + static_cast<double>(placement.offset_x);
    const double middle_v =
        1.0 - (0.5 * static_cast<double>(placement.tiling_y) + static_cast<double>(placement.offset_y));
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
    : source_(source), result_(result), map_(map), wrap_x_(wrap_x), wrap_y_(wrap_y), kind_(Kind::any) {
    if (map.uy == 0.0 && map.vx == 0.0) {
        const bool same = source == result && map.u0 == 0.0 && map.v0 == 0.0 && map.ux == 1.0 / result.width &&
                          map.vy == 1.0 / result.height;
        kind_ = same ? Kind::same : Kind::axes;
    }
    if (kind_ == Kind::same) return;
    columns_ = Taps(result.width);
    rows_ = Taps(kind_ == Kind::any ? result.width : 1);
    if (kind_ == Kind::any) return;
    tap_row(map.u0, map.ux, 0.0, wrap_x, source.width, columns_.padded(), columns_.row());
    runs_ = Plane<std::int32_t>({columns_.padded(), 1});
    find_runs(columns_.row(), columns_.padded(), aligned_count(source.width), runs_.row(0));
}

void Sampler::place(int j) {
    row_ = j;
    const double y = j + 0.5;
    if (kind_ == Kind::any)
        tap_row(map_.u0, map_.ux, map_.uy * y, wrap_x_, source_.width, columns_.padded(), columns_.row());
    if (kind_ != Kind::same)
        tap_row(map_.v0, map_.vx, map_.vy * y, wrap_y_, source_.height, rows_.padded(), rows_.row());
}

Sampler::Rows Sampler::rows() {
    if (is_whole()) return {row_, row_};
    return {rows_.row().first[0], rows_.row().second[0]};
}

void Sampler::sample(const float* upper, const float* lower, float* out) {
    if (is_whole()) {
        std::memcpy(out, upper, static_cast<std::size_t>(result_.width) * sizeof(float));
    } else {
        bilinear_row(upper, lower, columns_.row(), runs_.row(0), rows_.row().weight[0], result_.width, out);
    }
}

void Sampler::sample(const Plane<float>& plane, float* out) {
    if (is_along_rows()) {
        const Rows at = rows();
        return sample(plane.row(at.upper), plane.row(at.lower), out);
    }
    const TapRow columns = columns_.row();
    const TapRow rows = rows_.row();
    for (int i = 0; i < result_.width; ++i) {
        const float* upper = plane.row(rows.first[i]);
        const float* lower = plane.row(rows.second[i]);
        const int left = columns.first[i];
        const int right = columns.second[i];
        out[i] = mix(mix(upper[left], upper[right], columns.weight[i]),
                     mix(lower[left], lower[right], columns.weight[i]), rows.weight[i]);
    }
}

}  // namespace tex::inline v1
