// SPDX-License-Identifier: Apache-2.0
// layers.h: which picture of a texture array or a cube map is read (ReadOptions::layer).

#pragma once

#include <cstdint>
#include <string>

#include <tex/file.h>
#include <tex/types.h>

namespace tex::inline v1 {

// What a file holds: arrays of textures, or of cube maps with a picture for each face.
struct LayerCount {
    std::uint64_t layers = 1;  // all of them: of a cube map, its faces
    bool has_faces = false;
};

// The number of the layer that the options name; 0 if there is only one and they name none. The errors say how many
// there are. Errors: unsupported (several, and none is named), bad_option (there is no such layer).
Result<std::uint64_t> chosen_layer(const LayerCount& count, const std::string& name, const ReadOptions& options);

}  // namespace tex::inline v1
