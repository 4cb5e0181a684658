// SPDX-License-Identifier: Apache-2.0
// extra_rows.h: rows of the data beside the normals: NormalMap::alpha, blue and length.

#pragma once

#include <tex/format.h>
#include <tex/mip.h>
#include <tex/types.h>

#include "kernels/normal_row.h"

namespace tex::inline v1 {

// One value in channels of 5 and 6 bits, and a rebuilt z and a stored one, differ by less.
inline constexpr float kSameInBlocks = 8.5f / 255.0f;

// The set of the extras for which has(extra) is true.
template <class Has>
[[nodiscard]] ExtraSet extras_with(Has&& has) {
    ExtraSet extras;
    for (const Extra extra : kExtras) extras[extra] = has(extra);
    return extras;
}
[[nodiscard]] inline ExtraSet extras_of(const NormalMap& map) {
    return extras_with([&](Extra extra) { return !map[extra].empty(); });
}
[[nodiscard]] inline ExtraSet operator&(ExtraSet a, ExtraSet b) {
    return extras_with([&](Extra extra) { return a[extra] && b[extra]; });
}
[[nodiscard]] inline ExtraSet operator|(ExtraSet a, ExtraSet b) {
    return extras_with([&](Extra extra) { return a[extra] || b[extra]; });
}
[[nodiscard]] inline ExtraSet operator!(ExtraSet a) {
    return extras_with([&](Extra extra) { return !a[extra]; });
}

// Whether one file can hold all of them. Errors: bad_option.
[[nodiscard]] Result<void> check_together(ExtraSet extras);

// The channel that stores one as it is; -1: none.
[[nodiscard]] int channel_of(Extra extra);

// Gives a map planes for them.
void add_planes(NormalMap& map, ExtraSet extras);

// Makes row j of a map's extras from stored rows: those of its vectors, and of the channels that hold extras.
void unpack_extras(ExtraSet extras, const VectorRow& vectors, bool is_unsigned, const float* const (&channels)[4],
                   NormalMap& map, int j);

// What one is, for smaller levels.
[[nodiscard]] ExtraKind kind_of(Extra extra, const MipOptions& options);

// What is averaged for smaller levels: the values, or alpha^2 of roughness. Reads and writes whole vectors.
void values_to_average(ExtraKind kind, const float* values, int width, float* out);

// From averages to the values of a smaller level. `mean` are the averaged vectors, which matter to roughness alone.
void values_of_averages(ExtraKind kind, RoughnessModel model, const VectorRow& mean, const float* averages, int width,
                        float* out);

// What the lengths of stored vectors hold: see NormalMap::length. Vectors that are not finite hold 1.
void values_of_lengths(const float* x, const float* y, const float* z, bool is_unsigned, int width, float* out);

// Gives unit vectors the lengths that hold these values.
void lengthen(const VectorRow& unit, const float* values, int width, const NormalRow& out);

}  // namespace tex::inline v1
