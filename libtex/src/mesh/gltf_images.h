// SPDX-License-Identifier: Apache-2.0
// gltf_images.h: the images of a glTF file, and the normal maps that its materials make of them.

#pragma once

#include <vector>

#include <tex/mesh.h>
#include <tex/types.h>

#include "mesh/gltf_buffers.h"
#include "mesh/json.h"

namespace tex::inline v1 {

// Errors: bad_data.
Result<std::vector<ModelMap>> gltf_maps(JsonValue root);

// All images, with their uses, and the bytes of those that `maps` use. `ModelImage::file` is relative to the file. What
// is wrong with an image is its own error.
std::vector<ModelImage> gltf_images(JsonValue root, GltfBuffers& buffers, const std::vector<ModelMap>& maps);

}  // namespace tex::inline v1
