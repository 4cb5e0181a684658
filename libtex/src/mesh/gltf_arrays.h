// SPDX-License-Identifier: Apache-2.0
// gltf_arrays.h: numbers of a glTF file that are written anew, and the accessors and views that they get.

#pragma once

#include <cstddef>
#include <cstdint>
#include <list>
#include <map>
#include <string>
#include <vector>

#include "mesh/gltf_views.h"
#include "mesh/json.h"
#include "mesh/json_text.h"

namespace tex::inline v1 {

// Calls use(key, accessor, target) for each accessor that a primitive or a morph target names; target is -1 for the
// former.
template <class Use>
void visit_attributes(JsonValue primitive, const Use& use) {
    const JsonValue attributes = primitive["attributes"], targets = primitive["targets"];
    for (const std::string& key : attributes.keys()) {
        if (attributes[key].count()) use(key, attributes[key], -1);
    }
    for (std::size_t k = 0; k < targets.size(); ++k) {
        for (const std::string& key : targets[k].keys()) {
            if (targets[k][key].count()) use(key, targets[k][key], static_cast<int>(k));
        }
    }
}

// The object of the text that has such an accessor.
JsonNode* attributes_node(JsonNode& primitive, int target);

// The least significant byte first.
template <class T>
void put_number(std::vector<std::byte>& bytes, T value) {
    for (std::size_t k = 0; k < sizeof(T); ++k) bytes.push_back(static_cast<std::byte>(value >> (8 * k) & 0xff));
}

class GltfArrays {
public:
    // A member of the text that names an accessor.
    struct Use {
        JsonNode* object;
        std::string key;
    };
    // Numbers that become an accessor.
    struct Array {
        std::vector<std::byte> bytes;
        std::size_t count = 0, stride = 0;  // stride 0: elements follow each other
        bool is_index = false;
        std::string text;        // of the accessor, without place and count
        std::int64_t like = -1;  // the accessor that it replaces
        std::vector<Use> uses;
        std::size_t buffer = 0;
        bool is_in_place = false;  // nothing else uses that accessor
    };

    // What it is given must outlive it. `has_binary`: buffer 0 may be the binary chunk.
    GltfArrays(JsonValue root, JsonNode& text, GltfViews& views, bool has_binary);

    // How often primitives, skins and animations name an accessor.
    [[nodiscard]] std::size_t uses(std::int64_t accessor) const;
    // The buffer of the positions, or, if that only stands for compressed bytes, the first one that has bytes. Errors:
    // unsupported.
    [[nodiscard]] Result<std::size_t> buffer_for(JsonValue primitive) const;
    // The bytes of the list of indices, in two bytes each if `vertices` allows that.
    static void set_indices(Array& array, const std::vector<std::uint32_t>& corners, std::size_t vertices);

    void add(Array array) { arrays_.push_back(std::move(array)); }
    // Changes accessors, views and what names them. The views refer to this object from then on.
    void place();

private:
    void count_uses();
    void retire(const Array& array);
    std::int64_t view_for(Array& array);
    void place(Array& array);

    JsonValue root_;
    JsonNode& text_;
    GltfViews& views_;
    bool has_binary_;
    std::map<std::int64_t, std::size_t> uses_;
    std::map<std::int64_t, std::size_t> retired_;  // how many uses a view has lost
    std::list<Array> arrays_;                      // whose bytes views refer to
};

}  // namespace tex::inline v1
