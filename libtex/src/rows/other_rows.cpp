// SPDX-License-Identifier: Apache-2.0

#include "rows/other_rows.h"

#include <algorithm>
#include <cmath>

#include "kernels/roughness.h"

namespace tex::inline v1 {
namespace {

// Turns gloss into roughness, or back.
void invert(const float* from, int width, float* to) {
    for (int i = 0; i < width; ++i) to[i] = 1.0f - from[i];
}

}  // namespace

OtherKind kind_of(const OtherPlace& place, const MipOptions& options) {
    if (place.plane == &NormalMap::alpha) return options.alpha;
    return place.plane == &NormalMap::blue ? options.blue : OtherKind::occlusion;
}

void values_to_average(OtherKind kind, const float* values, int width, float* out) {
    if (!follows_normals(kind)) {
        std::copy_n(values, width, out);
        return;
    }
    Plane<float> roughness(Extent{width, 1});
    if (kind == OtherKind::gloss) {
        invert(values, width, roughness.row(0));
        values = roughness.row(0);
    }
    Plane<float> limited(Extent{width, 1});
    clean_roughness(values, width, limited.row(0), out);
}

void values_of_averages(OtherKind kind, RoughnessModel model, const VectorRow& mean, const float* averages, int width,
                        float* out) {
    if (!follows_normals(kind)) {
        std::copy_n(averages, width, out);
        return;
    }
    roughness_of_averages(model, mean.x, mean.y, mean.z, averages, width, out);
    if (kind == OtherKind::gloss) invert(out, width, out);
}

void values_of_lengths(const float* x, const float* y, const float* z, bool is_unsigned, int width, float* out) {
    const float scale = is_unsigned ? 2.0f : 1.0f, offset = is_unsigned ? 1.0f : 0.0f;
    for (int i = 0; i < width; ++i) {
        const float a = x[i] * scale - offset, b = y[i] * scale - offset, c = z[i] * scale - offset;
        const float root = 2.0f * std::sqrt(a * a + b * b + c * c) - 1.0f;
        out[i] = root < 1.0f ? std::max(root, 0.0f) * std::max(root, 0.0f) : 1.0f;
    }
}

void lengthen(const VectorRow& unit, const float* values, int width, const NormalRow& out) {
    for (int i = 0; i < width; ++i) {
        const float length = 0.5f + 0.5f * std::sqrt(values[i] > 0.0f ? std::min(values[i], 1.0f) : 0.0f);
        out.x[i] = unit.x[i] * length;
        out.y[i] = unit.y[i] * length;
        out.z[i] = unit.z[i] * length;
    }
}

}  // namespace tex::inline v1
