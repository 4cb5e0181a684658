// SPDX-License-Identifier: Apache-2.0

#include "glb.h"

#include <cstdint>
#include <cstring>
#include <map>

#include <assimp/material.h>
#include <nlohmann/json.hpp>

namespace tex::reader {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kFloat = 5126;  // the numbers of glTF for types of components
constexpr int kUnsigned = 5125;

class GlbWriter {
public:
    explicit GlbWriter(const aiScene& scene) : scene_(scene) {}

    Glb write() {
        json_["asset"] = {{"version", "2.0"}};
        for (unsigned k = 0; k < scene_.mNumMaterials; ++k) add_material(*scene_.mMaterials[k]);
        for (unsigned k = 0; k < scene_.mNumMeshes; ++k) primitives_.push_back(primitive_of(*scene_.mMeshes[k]));
        json_["nodes"] = Json::array();
        json_["meshes"] = Json::array();
        json_["scenes"] = {{{"nodes", {add_node(*scene_.mRootNode)}}}};
        json_["scene"] = 0;
        json_["buffers"] = {{{"byteLength", data_.size()}}};
        Glb glb;
        glb.json = json_.dump(-1, ' ', false, Json::error_handler_t::replace);
        glb.json.resize((glb.json.size() + 3) / 4 * 4, ' ');
        glb.data = std::move(data_);
        glb.data.resize((glb.data.size() + 3) / 4 * 4);
        return glb;
    }

private:
    void add_material(const aiMaterial& material) {
        aiString name;
        Json json = {{"name", material.Get(AI_MATKEY_NAME, name) == AI_SUCCESS ? name.C_Str() : ""}};
        if (material.GetTextureCount(aiTextureType_NORMALS) > 0) {
            json_["textures"] = {Json::object()};
            json["normalTexture"] = {{"index", 0}};
        }
        json_["materials"].push_back(json);
    }

    // Adds an array of `count` elements and returns the number of its accessor.
    int add_array(const void* from, std::size_t bytes, std::size_t count, int component, const char* type) {
        const auto* const begin = static_cast<const std::byte*>(from);
        const int number = static_cast<int>(json_["accessors"].size());
        json_["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", data_.size()}, {"byteLength", bytes}});
        json_["accessors"].push_back(
            {{"bufferView", number}, {"componentType", component}, {"count", count}, {"type", type}});
        data_.insert(data_.end(), begin, begin + bytes);
        return number;
    }

    template <class T>
    int add_array(const std::vector<T>& values, std::size_t per_element, int component, const char* type) {
        return add_array(values.data(), values.size() * sizeof(T), values.size() / per_element, component, type);
    }

    int add_vectors(const aiVector3D* from, unsigned count, std::size_t components) {
        std::vector<float> values;
        values.reserve(count * components);
        for (unsigned k = 0; k < count; ++k) {
            values.push_back(from[k].x);
            values.push_back(from[k].y);
            if (components == 3) values.push_back(from[k].z);
        }
        return add_array(values, components, kFloat, components == 3 ? "VEC3" : "VEC2");
    }

    int add_colors(const aiColor4D* from, unsigned count) {
        std::vector<float> values;
        values.reserve(std::size_t{count} * 3);
        for (unsigned k = 0; k < count; ++k) values.insert(values.end(), {from[k].r, from[k].g, from[k].b});
        return add_array(values, 3, kFloat, "VEC3");
    }

    // w is 1 if the bitangent, which points to greater v, is on the side of cross(N, T).
    int add_tangents(const aiMesh& mesh) {
        std::vector<float> values;
        values.reserve(std::size_t{mesh.mNumVertices} * 4);
        for (unsigned k = 0; k < mesh.mNumVertices; ++k) {
            const aiVector3D &n = mesh.mNormals[k], &t = mesh.mTangents[k], &b = mesh.mBitangents[k];
            values.insert(values.end(), {t.x, t.y, t.z, (n ^ t) * b < 0.0f ? -1.0f : 1.0f});
        }
        return add_array(values, 4, kFloat, "VEC4");
    }

    Json primitive_of(const aiMesh& mesh) {
        Json json = {{"material", mesh.mMaterialIndex}};
        Json& attributes = json["attributes"];
        attributes["POSITION"] = add_vectors(mesh.mVertices, mesh.mNumVertices, 3);
        if (mesh.HasNormals()) attributes["NORMAL"] = add_vectors(mesh.mNormals, mesh.mNumVertices, 3);
        if (mesh.HasNormals() && mesh.HasTangentsAndBitangents()) attributes["TANGENT"] = add_tangents(mesh);
        for (unsigned k = 0; k < AI_MAX_NUMBER_OF_TEXTURECOORDS && mesh.HasTextureCoords(k); ++k)
            attributes["TEXCOORD_" + std::to_string(k)] = add_vectors(mesh.mTextureCoords[k], mesh.mNumVertices, 2);
        if (mesh.HasVertexColors(0)) attributes["COLOR_0"] = add_colors(mesh.mColors[0], mesh.mNumVertices);
        std::vector<std::uint32_t> indices;
        indices.reserve(std::size_t{mesh.mNumFaces} * 3);
        for (unsigned k = 0; k < mesh.mNumFaces; ++k) {
            const aiFace& face = mesh.mFaces[k];
            indices.insert(indices.end(), face.mIndices, face.mIndices + face.mNumIndices);
        }
        json["indices"] = add_array(indices, 1, kUnsigned, "SCALAR");
        return json;
    }

    // The mesh of glTF with the meshes of a node as its primitives. Nodes with the same ones share it.
    int mesh_of(const aiNode& node) {
        const std::vector<unsigned> parts(node.mMeshes, node.mMeshes + node.mNumMeshes);
        const auto [place, is_new] = meshes_.try_emplace(parts, static_cast<int>(meshes_.size()));
        if (is_new) {
            Json mesh = {{"name", scene_.mMeshes[parts.front()]->mName.C_Str()}};
            for (const unsigned part : parts) mesh["primitives"].push_back(primitives_[part]);
            json_["meshes"].push_back(std::move(mesh));
        }
        return place->second;
    }

    // Returns the node's number. Assimp's importers limit how deep nodes are nested by the memory that they may use;
    // a stack that overflows ends this process alone.
    int add_node(const aiNode& node) {
        Json json = {{"name", node.mName.C_Str()}};
        if (!node.mTransformation.IsIdentity()) {
            for (unsigned column = 0; column < 4; ++column) {
                for (unsigned row = 0; row < 4; ++row) json["matrix"].push_back(node.mTransformation[row][column]);
            }
        }
        if (node.mNumMeshes > 0) json["mesh"] = mesh_of(node);
        for (unsigned k = 0; k < node.mNumChildren; ++k) json["children"].push_back(add_node(*node.mChildren[k]));
        json_["nodes"].push_back(std::move(json));
        return static_cast<int>(json_["nodes"].size()) - 1;
    }

    const aiScene& scene_;
    Json json_;
    std::vector<Json> primitives_;  // for each mesh of Assimp's
    std::map<std::vector<unsigned>, int> meshes_;
    std::vector<std::byte> data_;
};

}  // namespace

Glb glb_of(const aiScene& scene) { return GlbWriter(scene).write(); }

}  // namespace tex::reader
