// SPDX-License-Identifier: Apache-2.0

#include "draco.h"

#include <array>
#include <cstdint>
#include <cstring>
#include <memory>
#include <string>

#include <draco/compression/decode.h>
#include <draco/mesh/mesh.h>
#include <nlohmann/json.hpp>

namespace tex::reader {
namespace {

using DracoJson = nlohmann::ordered_json;

// The number of glTF for a type of components, and 5126 (float) for those that glTF does not have.
int component_of(draco::DataType type) {
    switch (type) {
        case draco::DT_INT8: return 5120;
        case draco::DT_UINT8: return 5121;
        case draco::DT_INT16: return 5122;
        case draco::DT_UINT16: return 5123;
        case draco::DT_UINT32: return 5125;
        default: return 5126;
    }
}

class DracoWriter {
public:
    DracoWriter() {
        json_["asset"] = {{"version", "2.0"}};
        json_["meshes"] = {{{"primitives", DracoJson::array()}}};
    }

    void add(const draco::Mesh& mesh) {
        DracoJson primitive = {{"attributes", DracoJson::object()}};
        for (int k = 0; k < mesh.num_attributes(); ++k) {
            const draco::PointAttribute& attribute = *mesh.attribute(k);
            if (attribute.num_components() < 1 || attribute.num_components() > 4) continue;
            primitive["attributes"][std::to_string(attribute.unique_id())] = add_attribute(mesh, attribute);
        }
        primitive["indices"] = add_indices(mesh);
        json_["meshes"][0]["primitives"].push_back(std::move(primitive));
    }

    Glb finish() {
        json_["buffers"] = {{{"byteLength", data_.size()}}};
        Glb glb;
        glb.json = json_.dump();
        glb.json.resize((glb.json.size() + 3) / 4 * 4, ' ');
        glb.data = std::move(data_);
        glb.data.resize((glb.data.size() + 3) / 4 * 4);
        return glb;
    }

private:
    int add_accessor(std::size_t from, std::size_t count, int component, const char* type) {
        const int number = static_cast<int>(json_["accessors"].size());
        json_["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", from}, {"byteLength", data_.size() - from}});
        json_["accessors"].push_back(
            {{"bufferView", number}, {"componentType", component}, {"count", count}, {"type", type}});
        return number;
    }

    template <class T>
    void convert(const draco::Mesh& mesh, const draco::PointAttribute& attribute) {
        const auto components = static_cast<std::int8_t>(attribute.num_components());
        for (std::uint32_t p = 0; p < mesh.num_points(); ++p) {
            std::array<T, 4> values{};
            attribute.ConvertValue<T>(attribute.mapped_index(draco::PointIndex(p)), components, values.data());
            const auto* const bytes = reinterpret_cast<const std::byte*>(values.data());
            data_.insert(data_.end(), bytes, bytes + sizeof(T) * static_cast<std::size_t>(components));
        }
    }

    int add_attribute(const draco::Mesh& mesh, const draco::PointAttribute& attribute) {
        static constexpr const char* kTypes[] = {"SCALAR", "VEC2", "VEC3", "VEC4"};
        const std::size_t from = data_.size();
        const int component = component_of(attribute.data_type());
        switch (component) {
            case 5120: convert<std::int8_t>(mesh, attribute); break;
            case 5121: convert<std::uint8_t>(mesh, attribute); break;
            case 5122: convert<std::int16_t>(mesh, attribute); break;
            case 5123: convert<std::uint16_t>(mesh, attribute); break;
            case 5125: convert<std::uint32_t>(mesh, attribute); break;
            default: convert<float>(mesh, attribute); break;
        }
        return add_accessor(from, mesh.num_points(), component, kTypes[attribute.num_components() - 1]);
    }

    int add_indices(const draco::Mesh& mesh) {
        const std::size_t from = data_.size();
        for (std::uint32_t f = 0; f < mesh.num_faces(); ++f) {
            for (const draco::PointIndex& corner : mesh.face(draco::FaceIndex(f))) {
                const std::uint32_t index = corner.value();
                const auto* const bytes = reinterpret_cast<const std::byte*>(&index);
                data_.insert(data_.end(), bytes, bytes + sizeof index);
            }
        }
        return add_accessor(from, std::size_t{mesh.num_faces()} * 3, 5125, "SCALAR");
    }

    DracoJson json_;
    std::vector<std::byte> data_;
};

}  // namespace

bool decode_draco(const void* request, std::size_t bytes, Glb& glb, ReaderHeader& header) {
    const auto* const from = static_cast<const char*>(request);
    DracoWriter writer;
    for (std::size_t at = 0; at < bytes;) {
        std::uint32_t size = 0;
        if (bytes - at < sizeof size) return refuse(header, ErrorCode::bad_data, "the request is damaged");
        std::memcpy(&size, from + at, sizeof size);
        at += sizeof size;
        if (bytes - at < size) return refuse(header, ErrorCode::bad_data, "the request is damaged");
        draco::DecoderBuffer buffer;
        buffer.Init(from + at, size);
        draco::Decoder decoder;
        auto mesh = decoder.DecodeMeshFromBuffer(&buffer);
        if (!mesh.ok()) {
            return refuse(header, ErrorCode::bad_data,
                          std::string("its Draco data is damaged: ") + mesh.status().error_msg());
        }
        writer.add(*mesh.value());
        at += (std::size_t{size} + 3) / 4 * 4;
    }
    glb = writer.finish();
    return true;
}

}  // namespace tex::reader
