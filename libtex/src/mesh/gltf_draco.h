// SPDX-License-Identifier: Apache-2.0
// gltf_draco.h: triangles of glTF that Draco compressed (KHR_draco_mesh_compression).
//
// Draco decodes in another process (formats/reader/reader_mesh.h). Request and answer are as for a file: all of its
// compressed buffers go out at once, each after its size (32 bits, little-endian) and padded to four bytes; the answer
// is a GLB file with one primitive for each of them, whose attributes are called by their numbers in Draco ("0").

#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <tex/types.h>

#include "mesh/gltf_buffers.h"
#include "mesh/json.h"

namespace tex::inline v1 {

// Decodes the buffers of a request. The answer is not to be trusted.
using DecodeDraco = std::function<Result<std::vector<std::byte>>(std::span<const std::byte> request)>;

class DracoTriangles {
public:
    // Decodes those primitives that have no other data, or all if the file requires the extension. Errors: bad_data,
    // unsupported (`decode` is empty), those of `decode`.
    static Result<DracoTriangles> decode(JsonValue root, GltfBuffers& buffers, const DecodeDraco& decode);

    [[nodiscard]] bool holds(JsonValue primitive) const;
    // Precondition: holds(). Errors: bad_data.
    Result<const GltfAccessor*> attribute(JsonValue primitive, const std::string& name);
    Result<const GltfAccessor*> indices(JsonValue primitive);

private:
    struct Answer;
    [[nodiscard]] JsonValue answer_for(JsonValue primitive) const;

    JsonValue root_;
    bool required_ = false;
    std::map<std::int64_t, std::size_t> by_view_;  // the number of the buffer in the request
    std::shared_ptr<Answer> answer_;
    std::map<std::string, GltfAccessor> accessors_;  // with `normalized` as the file says
};

}  // namespace tex::inline v1
