// SPDX-License-Identifier: Apache-2.0
// occluded_heights.h: occlusion of the heights that are baked. It depends on texels anywhere, so all heights are in
// memory before the first row of normals is made.

#pragma once

#include <tex/pipeline.h>

#include "rows/bake_rows.h"

namespace tex::inline v1 {

// Whether anything needs occlusion of the heights.
[[nodiscard]] bool wants_occlusion(const BakeFileOptions& options);

// What the options want of heights that are not blurred yet; NaN is a hole.
// Errors: those of occlusion(). May throw std::bad_alloc.
Result<OcclusionMaps> occluded_heights(Plane<float> heights, const HeightFieldHead& head,
                                       const BakeFileOptions& options, const Execution& execution);

// The inputs with planes instead of ExtraData::occlusion. `maps` must outlive them.
[[nodiscard]] ExtraInputs with_occlusion(const ExtraInputs& inputs, const OcclusionMaps& maps);

}  // namespace tex::inline v1
