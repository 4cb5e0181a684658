// SPDX-License-Identifier: Apache-2.0
// gltf_extensions.h: which extensions of glTF libtex reads, and which leave triangles and normal maps alone.

#pragma once

#include <string>
#include <vector>

#include <tex/types.h>

#include "mesh/json.h"

namespace tex::inline v1 {

// Errors: unsupported (the file requires an extension that is neither read nor known to be harmless, by its name).
Result<void> check_required_extensions(JsonValue root);

// A sentence for each extension that is neither, which the file uses where it may change UVs, normals or tangents: in
// primitives, accessors, buffer views and places of textures.
std::vector<std::string> ignored_extensions(JsonValue root);

}  // namespace tex::inline v1
