// SPDX-License-Identifier: Apache-2.0
// model_occlusion.h: occlusion in the pictures of a model.

#pragma once

#include <cstddef>
#include <vector>

#include <tex/types.h>

#include "tasks/job.h"
#include "tasks/model_input.h"
#include "tasks/model_output.h"

namespace tex::cli {

// The image that occlusion goes into, as planes R, G and B from 0 to 1; none if it gets a picture of its own.
[[nodiscard]] Result<Image> orm_of(const ModelInput& material, const ModelOcclusion& place, const ReadOptions& options);

// The bytes of the picture: `orm` with the occlusion as its red, or the occlusion alone if it has no planes. Both have
// the same extent.
[[nodiscard]] Result<std::vector<std::byte>> occlusion_picture(const Job& job, Plane<float> occlusion, Image orm,
                                                               Container container);

}  // namespace tex::cli
