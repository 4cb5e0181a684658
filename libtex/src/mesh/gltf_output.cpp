// SPDX-License-Identifier: Apache-2.0

#include "mesh/gltf_output.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>

#include "mesh/glb.h"
#include "mesh/gltf.h"
#include "mesh/gltf_form.h"
#include "mesh/gltf_names.h"
#include "mesh/json.h"
#include "mesh/json_text.h"

namespace tex::inline v1 {
namespace {

bool is_triangles(JsonValue mode) {
    const std::int64_t number = mode.is_null() ? 4 : mode.count().value_or(-1);
    return number >= 4 && number <= 6;
}

// ModelChanges::adds_material.
Result<std::vector<std::byte>> with_material(std::span<const std::byte> file) {
    const auto chunks = gltf_chunks(file);
    if (!chunks) return chunks.error();
    const auto document = JsonDocument::parse(chunks->json);
    if (!document) return document.error();
    const JsonValue root = document->root(), meshes = root["meshes"];
    JsonText text(chunks->json);
    for (std::size_t m = 0; m < meshes.size(); ++m) {
        const JsonValue primitives = meshes[m]["primitives"];
        for (std::size_t p = 0; p < primitives.size(); ++p) {
            const JsonValue attributes = primitives[p]["attributes"];
            if (!primitives[p]["material"].is_null() || !is_triangles(primitives[p]["mode"]) ||
                attributes["TEXCOORD_0"].is_null() || attributes["NORMAL"].is_null())
                continue;
            JsonNode& node = *text.root().member("meshes")->element(m)->member("primitives")->element(p);
            node.set("material", std::to_string(root["materials"].size()));
        }
    }
    if (text.root().member("materials") == nullptr) text.root().set("materials", "[]");
    text.root().member("materials")->append("{}");
    return with_chunks(file, *chunks, text.text(), std::nullopt);
}

// The name of the file that gets the binary chunk: it is called as the output, unless others have this name.
std::string binary_name(const ModelPlace& place, const std::vector<BesideModel>& beside) {
    const std::string stem = place.name.substr(0, place.name.rfind('.'));
    const auto is_free = [&](const std::string& name) {
        return std::none_of(beside.begin(), beside.end(), [&](const BesideModel& file) { return file.path == name; });
    };
    std::string name = stem + ".bin";
    for (int k = 2; !is_free(name); ++k) name = stem + "_" + std::to_string(k) + ".bin";
    return name;
}

}  // namespace

Result<WrittenGltf> write_gltf(std::span<const std::byte> file, const LoadBeside& load, const ModelPlace& place,
                               const ModelChanges& changes) {
    if (changes.adds_material) {
        const auto added = with_material(file);
        if (!added) return added.error();
        const ModelChanges then{changes.pictures, changes.tangents, false};
        return write_gltf(*added, load, place, then);
    }
    const bool is_binary = !file.empty() && file[0] == std::byte{'g'};
    if (is_binary == place.is_binary) return write_same_form(file, load, place, changes);
    if (!is_binary) {
        auto joined = joined_gltf(file, load, place);
        if (!joined) return joined.error();
        auto written = write_same_form(joined->bytes, load, place, changes);
        if (written) written->joined = std::move(joined->files);
        return written;
    }
    auto written = write_same_form(file, load, place, changes);
    if (!written) return written;
    const std::string name = binary_name(place, written->beside);
    auto divided = divided_gltf(written->bytes, uri_of_path(name));
    if (!divided) return divided.error();
    written->bytes = std::move(divided->text);
    if (!divided->binary.empty()) written->beside.push_back({name, "", true, std::move(divided->binary)});
    return written;
}

}  // namespace tex::inline v1
