// SPDX-License-Identifier: Apache-2.0
// gltf_form.h: glTF as text with files beside it, made one GLB file, and the other way round.

#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <tex/types.h>

#include "mesh/gltf_buffers.h"
#include "mesh/gltf_names.h"

namespace tex::inline v1 {

struct JoinedGltf {
    std::vector<std::byte> bytes;    // of a GLB file
    std::vector<std::string> files;  // relative paths of what was beside the text and is in it now
};

// Text as GLB: buffers become one, and images parts of it. Images that are not there, and what else the text names,
// stay where they are. Errors: bad_data, unsupported (4 GiB or more), those of `load`.
Result<JoinedGltf> joined_gltf(std::span<const std::byte> text, const LoadBeside& load, const ModelPlace& place);

struct DividedGltf {
    std::vector<std::byte> text;
    std::vector<std::byte> binary;  // what the file beside it holds; empty: there is none
};

// GLB as text, with the binary chunk, in which images stay, in a file with this URI. Errors: bad_data; unsupported
// (there are chunks that text cannot hold).
Result<DividedGltf> divided_gltf(std::span<const std::byte> glb, const std::string& uri);

}  // namespace tex::inline v1
