// SPDX-License-Identifier: Apache-2.0
// other_rows.h: rows of the data beside the normals: NormalMap::blue and NormalMap::alpha.

#pragma once

#include <tex/format.h>
#include <tex/mip_options.h>
#include <tex/normal_map.h>

#include "kernels/normal_row.h"

namespace tex {

[[nodiscard]] inline OtherPlanes others_of(const NormalMap& map) { return {!map.blue.empty(), !map.alpha.empty()}; }

// What is averaged for smaller levels: the values, or alpha^2 of roughness. Reads and writes whole vectors.
void values_to_average(OtherKind kind, const float* values, int width, float* out);

// From averages to the values of a smaller level. `mean` are the averaged vectors, which matter to roughness alone.
void values_of_averages(OtherKind kind, RoughnessModel model, const VectorRow& mean, const float* averages, int width,
                        float* out);

}  // namespace tex
