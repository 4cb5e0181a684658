// SPDX-License-Identifier: Apache-2.0
// reader_mesh.h: meshes of file types that Assimp reads, and Draco, in a separate process: tex-mesh-reader.

#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <tex/file.h>
#include <tex/types.h>

namespace tex::inline v1 {

// Reads a mesh and returns it as GLB, whose UVs have v up. The extension of the path helps Assimp to tell file types
// apart. The GLB is not to be trusted.
//
// Errors: io           the program is missing or cannot be started
//         bad_data     damaged; the program crashed or did not end in time
//         unsupported  not a mesh that Assimp reads; too large for options.reader_memory
//         out_of_memory
Result<std::vector<std::byte>> read_with_mesh_reader(const std::string& path, std::span<const std::byte> file,
                                                     const ReadOptions& options);

// Decodes what Draco compressed: a request becomes an answer, as mesh/gltf_draco.h describes them. Errors: as above.
Result<std::vector<std::byte>> decode_draco_with_reader(const std::string& path, std::span<const std::byte> request,
                                                        const ReadOptions& options);

}  // namespace tex::inline v1
