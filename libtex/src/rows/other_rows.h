// SPDX-License-Identifier: Apache-2.0
// other_rows.h: rows of the data beside the normals: NormalMap::alpha, blue and length.

#pragma once

#include <tex/format.h>
#include <tex/mip.h>
#include <tex/types.h>

#include "kernels/normal_row.h"

namespace tex::inline v1 {

// One value in channels of 5 and 6 bits, and a rebuilt z and a stored one, differ by less.
inline constexpr float kSameInBlocks = 8.5f / 255.0f;

// The places of data beside normals, in the order of their planes in strips (stream/stage.h).
struct OtherPlace {
    bool OtherPlanes::*has;
    Plane<float> NormalMap::*plane;
    const char* name;
};
inline constexpr OtherPlace kOtherPlaces[] = {
    {&OtherPlanes::alpha, &NormalMap::alpha, "alpha"},
    {&OtherPlanes::blue, &NormalMap::blue, "blue"},
    {&OtherPlanes::length, &NormalMap::length, "length"},
};

[[nodiscard]] inline OtherPlanes others_of(const NormalMap& map) {
    return {!map.blue.empty(), !map.alpha.empty(), !map.length.empty()};
}

[[nodiscard]] inline OtherPlanes operator&(OtherPlanes a, OtherPlanes b) {
    return {a.blue && b.blue, a.alpha && b.alpha, a.length && b.length};
}
[[nodiscard]] inline OtherPlanes operator|(OtherPlanes a, OtherPlanes b) {
    return {a.blue || b.blue, a.alpha || b.alpha, a.length || b.length};
}
[[nodiscard]] inline OtherPlanes operator!(OtherPlanes a) { return {!a.blue, !a.alpha, !a.length}; }

// What a place holds, for smaller levels.
[[nodiscard]] OtherKind kind_of(const OtherPlace& place, const MipOptions& options);

// What is averaged for smaller levels: the values, or alpha^2 of roughness. Reads and writes whole vectors.
void values_to_average(OtherKind kind, const float* values, int width, float* out);

// From averages to the values of a smaller level. `mean` are the averaged vectors, which matter to roughness alone.
void values_of_averages(OtherKind kind, RoughnessModel model, const VectorRow& mean, const float* averages, int width,
                        float* out);

// What the lengths of stored vectors hold: see NormalMap::length. Vectors that are not finite hold 1.
void values_of_lengths(const float* x, const float* y, const float* z, bool is_unsigned, int width, float* out);

// Gives unit vectors the lengths that hold these values.
void lengthen(const VectorRow& unit, const float* values, int width, const NormalRow& out);

}  // namespace tex::inline v1
