// SPDX-License-Identifier: Apache-2.0

#include "rows/extra_rows.h"

#include <algorithm>
#include <cmath>

#include "kernels/roughness.h"
#include "rows/usable.h"

namespace tex::inline v1 {
namespace {

// Turns gloss into roughness, or back.
void invert(const float* from, int width, float* to) {
    for (int i = 0; i < width; ++i) to[i] = 1.0f - from[i];
}

}  // namespace

Result<void> check_together(ExtraSet extras) {
    if (!extras.blue || !extras.length) return {};
    return bad_option("blue and length exclude each other: without z, a vector has no length");
}

int channel_of(Extra extra) { return extra == Extra::alpha ? 3 : extra == Extra::blue ? 2 : -1; }

void add_planes(NormalMap& map, ExtraSet extras) {
    for (const Extra extra : kExtras) {
        if (extras[extra]) map[extra] = Plane<float>(map.extent());
    }
}

void unpack_extras(ExtraSet extras, const VectorRow& vectors, bool is_unsigned, const float* const (&channels)[4],
                   NormalMap& map, int j) {
    const int width = map.extent().width;
    for (const Extra extra : kExtras) {
        if (!extras[extra]) continue;
        if (const int channel = channel_of(extra); channel >= 0) {
            std::copy_n(channels[channel], width, map[extra].row(j));
        } else {
            values_of_lengths(vectors.x, vectors.y, vectors.z, is_unsigned, width, map[extra].row(j));
        }
    }
}

ExtraKind kind_of(Extra extra, const MipOptions& options) {
    if (extra == Extra::length) return ExtraKind::occlusion;
    return extra == Extra::alpha ? options.alpha : options.blue;
}

void values_to_average(ExtraKind kind, const float* values, int width, float* out) {
    if (!follows_normals(kind)) {
        std::copy_n(values, width, out);
        return;
    }
    Plane<float> roughness(Extent{width, 1});
    if (kind == ExtraKind::gloss) {
        invert(values, width, roughness.row(0));
        values = roughness.row(0);
    }
    Plane<float> limited(Extent{width, 1});
    clean_roughness(values, width, limited.row(0), out);
}

void values_of_averages(ExtraKind kind, RoughnessModel model, const VectorRow& mean, const float* averages, int width,
                        float* out) {
    if (!follows_normals(kind)) {
        std::copy_n(averages, width, out);
        return;
    }
    roughness_of_averages(model, mean.x, mean.y, mean.z, averages, width, out);
    if (kind == ExtraKind::gloss) invert(out, width, out);
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
