// SPDX-License-Identifier: Apache-2.0

#include "mesh/gltf_draco.h"

#include <cstdint>
#include <optional>
#include <utility>

#include "mesh/gltf.h"

namespace tex::inline v1 {
namespace {

constexpr const char* kDraco = "KHR_draco_mesh_compression";

JsonValue draco_of(JsonValue primitive) { return primitive["extensions"][kDraco]; }

bool requires_draco(JsonValue root) {
    const JsonValue required = root["extensionsRequired"];
    for (std::size_t k = 0; k < required.size(); ++k) {
        if (required[k].text() == kDraco) return true;
    }
    return false;
}

// Whether the primitive has positions that any reader can read.
bool has_plain_positions(JsonValue root, JsonValue primitive) {
    const auto number = primitive["attributes"]["POSITION"].count();
    const JsonValue accessor = number ? root["accessors"][static_cast<std::size_t>(*number)] : JsonValue();
    return !accessor["bufferView"].is_null() || !accessor["sparse"].is_null();
}

void append_buffer(std::vector<std::byte>& request, std::span<const std::byte> bytes) {
    const auto size = static_cast<std::uint32_t>(bytes.size());
    for (unsigned k = 0; k < 4; ++k) request.push_back(static_cast<std::byte>(size >> (8 * k) & 0xff));
    request.insert(request.end(), bytes.begin(), bytes.end());
    while (request.size() % 4 != 0) request.push_back(std::byte{});
}

}  // namespace

struct DracoTriangles::Answer {
    std::vector<std::byte> bytes;
    LoadBeside nothing;
    std::optional<JsonDocument> document;
    std::optional<GltfBuffers> buffers;
};

Result<DracoTriangles> DracoTriangles::decode(JsonValue root, GltfBuffers& buffers, const DecodeDraco& decode) {
    DracoTriangles triangles;
    triangles.root_ = root;
    triangles.required_ = requires_draco(root);
    std::vector<std::byte> request;
    const JsonValue meshes = root["meshes"];
    for (std::size_t m = 0; m < meshes.size(); ++m) {
        const JsonValue primitives = meshes[m]["primitives"];
        for (std::size_t p = 0; p < primitives.size(); ++p) {
            const JsonValue draco = draco_of(primitives[p]);
            if (draco.is_null() || (!triangles.required_ && has_plain_positions(root, primitives[p]))) continue;
            const auto bytes = buffers.view_bytes(draco["bufferView"]);
            if (!bytes) return bytes.error();
            const auto view = draco["bufferView"].count().value_or(0);
            if (!triangles.by_view_.try_emplace(view, triangles.by_view_.size()).second) continue;
            if (bytes->size() > UINT32_MAX) return bad_gltf("has too long a buffer for Draco");
            append_buffer(request, *bytes);
        }
    }
    if (triangles.by_view_.empty()) return triangles;
    if (!decode) return Error{ErrorCode::unsupported, {}, "is compressed by Draco"};
    auto decoded = decode(request);
    if (!decoded) return decoded.error();
    triangles.answer_ = std::make_shared<Answer>();
    Answer& answer = *triangles.answer_;
    answer.bytes = std::move(*decoded);
    answer.nothing = [](const std::string&) -> Result<std::vector<std::byte>> {
        return bad_gltf("the mesh reader returned invalid data");
    };
    const auto chunks = gltf_chunks(answer.bytes);
    if (!chunks) return chunks.error();
    auto document = JsonDocument::parse(chunks->json);
    if (!document) return document.error();
    answer.document = std::move(*document);
    answer.buffers.emplace(answer.document->root(), chunks->json.size(), chunks->binary, answer.nothing);
    buffers.count_decoded(answer.bytes.size());
    return triangles;
}

bool DracoTriangles::holds(JsonValue primitive) const {
    const JsonValue draco = draco_of(primitive);
    return !draco.is_null() && (required_ || !has_plain_positions(root_, primitive));
}

JsonValue DracoTriangles::answer_for(JsonValue primitive) const {
    const auto found = by_view_.find(draco_of(primitive)["bufferView"].count().value_or(-1));
    if (found == by_view_.end()) return {};
    return answer_->document->root()["meshes"][std::size_t{0}]["primitives"][found->second];
}

Result<const GltfAccessor*> DracoTriangles::attribute(JsonValue primitive, const std::string& name) {
    const auto number = draco_of(primitive)["attributes"][name].count();
    if (!number) return bad_gltf("is not in the data that Draco compressed");
    const auto decoded = answer_->buffers->accessor(answer_for(primitive)["attributes"][std::to_string(*number)]);
    if (!decoded) return bad_gltf("attribute " + std::to_string(*number) + " of Draco does not exist");
    const auto own = primitive["attributes"][name].count();
    const JsonValue description = own ? root_["accessors"][static_cast<std::size_t>(*own)] : JsonValue();
    const std::string key = std::to_string(draco_of(primitive)["bufferView"].count().value_or(0)) + "/" +
                            std::to_string(*number) + "/" + std::to_string(own.value_or(-1));
    GltfAccessor& accessor = accessors_.insert_or_assign(key, **decoded).first->second;
    accessor.normalized = accessor.type != 5126 && description["normalized"].boolean().value_or(false);
    return &accessor;
}

Result<const GltfAccessor*> DracoTriangles::indices(JsonValue primitive) {
    return answer_->buffers->accessor(answer_for(primitive)["indices"]);
}

}  // namespace tex::inline v1
