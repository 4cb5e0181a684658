// SPDX-License-Identifier: Apache-2.0

#include "rows/other_rows.h"

#include <algorithm>

#include "kernels/roughness.h"

namespace tex {
namespace {

// Turns gloss into roughness, or back.
void invert(const float* from, int width, float* to) {
    for (int i = 0; i < width; ++i) to[i] = 1.0f - from[i];
}

}  // namespace

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

}  // namespace tex
