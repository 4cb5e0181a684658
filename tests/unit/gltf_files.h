// SPDX-License-Identifier: Apache-2.0
// gltf_files.h: small glTF files for tests, made part by part.

#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace tex {

// Collects numbers for the binary chunk, with a buffer view and an accessor for each list.
class GltfMaker {
public:
    // Returns the number of the accessor. `type`: "VEC3"; `component`: 5126 for float.
    template <class T>
    int add(const std::vector<T>& values, const std::string& type, int component, const std::string& more = "") {
        const int components = type == "SCALAR" ? 1 : type.back() - '0';
        const int view = add_view(values);
        return add_accessor(values.size() / static_cast<std::size_t>(components), type, component,
                            ",\"bufferView\":" + std::to_string(view) + more);
    }
    template <class T>
    int add_view(const std::vector<T>& values) {
        while (binary.size() % 4 != 0) binary += '\0';
        const std::size_t offset = binary.size(), bytes = values.size() * sizeof(T);
        binary.append(reinterpret_cast<const char*>(values.data()), bytes);
        views += (views.empty() ? "" : ",") + std::string("{\"buffer\":0,\"byteOffset\":") + std::to_string(offset) +
                 ",\"byteLength\":" + std::to_string(bytes) + "}";
        return view_count++;
    }
    int add_accessor(std::size_t count, const std::string& type, int component, const std::string& more) {
        accessors += (accessors.empty() ? "" : ",") + std::string("{\"count\":") + std::to_string(count) +
                     ",\"type\":\"" + type + "\",\"componentType\":" + std::to_string(component) + more + "}";
        return accessor_count++;
    }

    // The JSON, with `primitives` as one mesh and `rest` (",\"nodes\":[...]") at its end.
    [[nodiscard]] std::string json(const std::string& primitives, const std::string& rest = "") const {
        return R"({"asset":{"version":"2.0"},"buffers":[{)" + uri + "\"byteLength\":" + std::to_string(binary.size()) +
               "}],\"bufferViews\":[" + views + "],\"accessors\":[" + accessors + R"(],"meshes":[{"name":"m",)" +
               "\"primitives\":[" + primitives + "]}]" + rest + "}";
    }
    [[nodiscard]] std::string glb(const std::string& primitives, const std::string& rest = "") const {
        return glb_of(json(primitives, rest), binary);
    }
    [[nodiscard]] static std::string glb_of(std::string text, std::string bytes) {
        while (text.size() % 4 != 0) text += ' ';
        while (bytes.size() % 4 != 0) bytes += '\0';
        std::string file = "glTF" + u32(2) + u32(static_cast<std::uint32_t>(28 + text.size() + bytes.size()));
        file += u32(static_cast<std::uint32_t>(text.size())) + "JSON" + text;
        return file + u32(static_cast<std::uint32_t>(bytes.size())) + std::string("BIN\0", 4) + bytes;
    }

    std::string binary, views, accessors;
    std::string uri;  // "\"uri\":\"a.bin\","
    int view_count = 0, accessor_count = 0;

private:
    static std::string u32(std::uint32_t value) {
        std::string bytes(4, '\0');
        std::memcpy(bytes.data(), &value, 4);
        return bytes;
    }
};

}  // namespace tex
