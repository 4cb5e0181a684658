// SPDX-License-Identifier: Apache-2.0
// gltf_tangents.h: other tangents for the primitives of a glTF file.

#pragma once

#include <cstddef>
#include <cstdint>
#include <list>
#include <map>
#include <string>
#include <vector>

#include <tex/pipeline.h>
#include <tex/types.h>

#include "mesh/gltf_arrays.h"
#include "mesh/gltf_buffers.h"
#include "mesh/gltf_views.h"
#include "mesh/json.h"
#include "mesh/json_text.h"

namespace tex::inline v1 {

// Primitives that have the same attributes share their vertices, and so they share what is made of them.
class GltfTangents {
public:
    // What it is given must outlive it. `has_binary`: buffer 0 may be the binary chunk.
    GltfTangents(JsonValue root, JsonNode& text, GltfBuffers& buffers, GltfViews& views, bool has_binary)
        : root_(root), text_(text), buffers_(buffers), views_(views), arrays_(root, text, views, has_binary) {}

    // Changes primitives, accessors and views. The views refer to this object. Tangents may be empty, to see which
    // buffers change. Errors: those of accessors; bad_option, unsupported as write_model().
    Result<void> change(const std::vector<ModelTangents>& tangents);
    // Primitives that stay as they are, because Draco compresses them.
    [[nodiscard]] int compressed() const { return compressed_; }

private:
    struct Member {
        JsonValue primitive;
        JsonNode* node = nullptr;
        std::vector<std::uint32_t> corners;
        std::int64_t mode = 4;
        bool is_split = false;  // corners have other vertices than in the file
    };
    struct Vertices {
        std::size_t count = 0;  // in the file
        std::vector<Float4> tangents;
        std::vector<bool> is_known;         // of those in the file: a corner has it
        std::vector<std::uint32_t> copies;  // of which vertex the further ones are
        std::multimap<std::uint32_t, std::uint32_t> copies_of;
        std::list<Member> members;
    };
    using Array = GltfArrays::Array;
    using Use = GltfArrays::Use;

    Result<void> add(const ModelTangents& tangents);
    Result<void> read_corners(Member& member, std::size_t vertices, std::size_t tangents);
    Result<void> charge(std::size_t count, std::size_t size);
    static std::uint32_t vertex_for(Vertices& vertices, std::uint32_t vertex, const Float4& tangent);
    Result<void> collect(const Vertices& vertices);
    Result<void> collect_attributes(const Vertices& vertices, std::size_t buffer);
    void collect_tangents(const Vertices& vertices, std::size_t buffer);
    void collect_indices(const Vertices& vertices, const Member& member, std::size_t buffer);

    JsonValue root_;
    JsonNode& text_;
    GltfBuffers& buffers_;
    GltfViews& views_;
    int compressed_ = 0;
    std::size_t charged_ = 0;                   // bytes that are added
    std::map<std::string, Vertices> vertices_;  // by the accessors of their attributes
    GltfArrays arrays_;
};

}  // namespace tex::inline v1
