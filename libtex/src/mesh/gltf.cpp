// SPDX-License-Identifier: Apache-2.0

#include "mesh/gltf.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <tex/mesh.h>

#include "mesh/gltf_corners.h"
#include "mesh/gltf_extensions.h"
#include "mesh/gltf_materials.h"

namespace tex::inline v1 {
namespace {

constexpr const char* kColors = "COLOR_0";

// glTF forbids it, but some editors write it, and engines read such files.
constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";

Error unsupported(std::string reason) { return {ErrorCode::unsupported, {}, std::move(reason)}; }

std::uint32_t load_u32(std::span<const std::byte> bytes, std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t k = 4; k-- > 0;) value = value << 8 | std::to_integer<std::uint32_t>(bytes[at + k]);
    return value;
}

std::string_view text_of(std::span<const std::byte> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// Reads primitives. What a file claims is compared with its bytes: triangles that use the same numbers many times over
// would take memory out of proportion.
class PrimitiveReader {
public:
    PrimitiveReader(JsonValue root, GltfBuffers& buffers, DracoTriangles& compressed, bool colors)
        : materials_(root["materials"].size()), buffers_(buffers), compressed_(compressed), colors_(colors) {}

    Result<void> read(JsonValue primitive, MeshPart& part);

private:
    using Read = std::vector<std::uint32_t>;

    Result<Read> corners_of(JsonValue primitive, std::size_t vertices);
    Read used_of(Read& corners, std::size_t vertices);
    Result<const GltfAccessor*> attribute(JsonValue primitive, const std::string& name, int components);
    template <class T>
    Result<void> fill(JsonValue primitive, const std::string& name, const Read& used, std::vector<T>& values);
    Result<void> read_attributes(JsonValue primitive, const Read& used, MeshPart& part);
    Result<void> read_colors(JsonValue primitive, const Read& used, MeshPart& part);
    Result<void> read_variants(JsonValue primitive, MeshPart& part) const;

    std::size_t materials_;
    GltfBuffers& buffers_;
    DracoTriangles& compressed_;
    bool colors_;
    std::size_t vertices_ = 0;  // of this primitive
    std::size_t corners_ = 0;   // of all primitives so far
    std::uint32_t round_ = 0;
    std::vector<std::uint32_t> seen_in_;  // for each vertex, the primitive that last used it
    std::vector<std::uint32_t> place_;
};

Result<PrimitiveReader::Read> PrimitiveReader::corners_of(JsonValue primitive, std::size_t vertices) {
    auto mode = primitive["mode"].is_null() ? std::optional<std::int64_t>(4) : primitive["mode"].count();
    if (!mode || *mode > 6) return bad_gltf("its mode is not one of glTF's");
    const JsonValue index = primitive["indices"];
    const GltfAccessor* indices = nullptr;
    if (compressed_.holds(primitive)) {
        const auto accessor = compressed_.indices(primitive);
        if (!accessor) return accessor.error();
        indices = *accessor;
        if (*mode >= 4) mode = 4;  // strips become triangles
    } else if (!index.is_null()) {
        const auto accessor = buffers_.accessor(index);
        if (!accessor) return accessor.error();
        indices = *accessor;
    }
    if (indices != nullptr &&
        (indices->components != 1 || (indices->type != 5121 && indices->type != 5123 && indices->type != 5125)))
        return bad_gltf("its indices are not unsigned integers");
    Read corners;
    if (*mode < 4) return corners;  // points and lines
    const std::size_t count = indices == nullptr ? vertices : indices->count;
    corners_ += count;
    if (corners_ > buffers_.bytes() || count / 3 > kMaxTriangles)
        return bad_gltf("claims more triangles than the bytes of the file can hold");
    corners.resize(count);
    for (std::size_t k = 0; k < count; ++k) {
        corners[k] = indices == nullptr ? static_cast<std::uint32_t>(k) : indices->integer(k);
        if (corners[k] >= vertices) {
            return bad_gltf("index " + std::to_string(corners[k]) + " is out of range: there are " +
                            std::to_string(vertices) + " vertices");
        }
    }
    return triangles_of(std::move(corners), *mode);
}

// Numbers the vertices that corners use, in the order of the file, and returns their old numbers.
PrimitiveReader::Read PrimitiveReader::used_of(Read& corners, std::size_t vertices) {
    if (seen_in_.size() < vertices) {
        seen_in_.resize(vertices, 0);
        place_.resize(vertices);
    }
    ++round_;
    Read used;
    for (const std::uint32_t v : corners) {
        if (seen_in_[v] == round_) continue;
        seen_in_[v] = round_;
        used.push_back(v);
    }
    std::sort(used.begin(), used.end());
    for (std::size_t k = 0; k < used.size(); ++k) place_[used[k]] = static_cast<std::uint32_t>(k);
    for (std::uint32_t& v : corners) v = place_[v];
    return used;
}

void assign(const GltfAccessor& a, std::size_t k, Float2& v) { v = {a.number(k, 0), a.number(k, 1)}; }
void assign(const GltfAccessor& a, std::size_t k, Float3& v) { v = {a.number(k, 0), a.number(k, 1), a.number(k, 2)}; }
void assign(const GltfAccessor& a, std::size_t k, Float4& v) {
    v = {a.number(k, 0), a.number(k, 1), a.number(k, 2), a.number(k, 3)};
}

Result<const GltfAccessor*> PrimitiveReader::attribute(JsonValue primitive, const std::string& name, int components) {
    const auto accessor = compressed_.holds(primitive) ? compressed_.attribute(primitive, name)
                                                       : buffers_.accessor(primitive["attributes"][name]);
    if (!accessor) {
        Error error = accessor.error();
        if (error.file.empty()) error.reason = name + ": " + error.reason;
        return error;
    }
    const GltfAccessor& found = **accessor;
    const bool is_vector = name == "NORMAL" || name == "TANGENT";  // floats, or fractions with a sign
    const bool is_color = name == kColors;                         // floats, or fractions without one; alpha may follow
    const bool fits_vector = found.type == 5126 || (found.normalized && (found.type == 5120 || found.type == 5122));
    const bool fits_color = found.type == 5126 || (found.normalized && (found.type == 5121 || found.type == 5123));
    const bool has_alpha = is_color && found.components == components + 1;
    if ((found.components != components && !has_alpha) || found.type == 5125 || (is_vector && !fits_vector) ||
        (is_color && !fits_color))
        return bad_gltf(name + " has numbers of the wrong type");
    if (vertices_ != 0 && (*accessor)->count != vertices_) {
        return bad_gltf(name + " has " + std::to_string((*accessor)->count) + " elements for " +
                        std::to_string(vertices_) + " vertices");
    }
    return *accessor;
}

template <class T>
Result<void> PrimitiveReader::fill(JsonValue primitive, const std::string& name, const Read& used,
                                   std::vector<T>& values) {
    const auto accessor = attribute(primitive, name, static_cast<int>(sizeof(T) / sizeof(float)));
    if (!accessor) return accessor.error();
    values.resize(used.size());
    for (std::size_t k = 0; k < used.size(); ++k) assign(**accessor, used[k], values[k]);
    return {};
}

Result<void> PrimitiveReader::read_colors(JsonValue primitive, const Read& used, MeshPart& part) {
    if (!colors_ || primitive["attributes"][kColors].is_null()) return {};
    return fill(primitive, kColors, used, part.colors);
}

Result<void> PrimitiveReader::read_variants(JsonValue primitive, MeshPart& part) const {
    const JsonValue mappings = primitive["extensions"]["KHR_materials_variants"]["mappings"];
    std::vector<int>& variants = part.variants;
    for (std::size_t k = 0; k < mappings.size(); ++k) {
        const auto number = mappings[k]["material"].count();
        if (!number || static_cast<std::size_t>(*number) >= materials_)
            return bad_gltf("the material of a variant does not exist");
        if (static_cast<int>(*number) != part.material) variants.push_back(static_cast<int>(*number));
    }
    std::sort(variants.begin(), variants.end());
    variants.erase(std::unique(variants.begin(), variants.end()), variants.end());
    return {};
}

Result<void> PrimitiveReader::read_attributes(JsonValue primitive, const Read& used, MeshPart& part) {
    const JsonValue attributes = primitive["attributes"];
    if (const auto done = fill(primitive, "POSITION", used, part.positions); !done) return done.error();
    if (!attributes["NORMAL"].is_null()) {
        if (const auto done = fill(primitive, "NORMAL", used, part.normals); !done) return done.error();
    }
    if (!attributes["TANGENT"].is_null()) {
        if (const auto done = fill(primitive, "TANGENT", used, part.tangents); !done) return done.error();
    }
    for (int set = 0; set < kMaxUvSets; ++set) {
        const std::string name = "TEXCOORD_" + std::to_string(set);
        if (attributes[name].is_null()) continue;
        if (part.uvs.size() != static_cast<std::size_t>(set))
            return bad_gltf("has " + name + ", but not TEXCOORD_" + std::to_string(part.uvs.size()));
        part.uvs.emplace_back();
        if (const auto done = fill(primitive, name, used, part.uvs.back()); !done) return done.error();
    }
    return read_colors(primitive, used, part);
}

Result<void> PrimitiveReader::read(JsonValue primitive, MeshPart& part) {
    const JsonValue material = primitive["material"];
    vertices_ = 0;
    // Without positions, nothing is drawn (glTF 2.0, 3.7.2.1).
    const JsonValue attributes = primitive["attributes"];
    if (!compressed_.holds(primitive) && !attributes.is_null() && attributes["POSITION"].is_null()) return {};
    const auto positions = attribute(primitive, "POSITION", 3);
    if (!positions) return positions.error();
    vertices_ = (*positions)->count;
    auto corners = corners_of(primitive, vertices_);
    if (!corners) return corners.error();
    if (!material.is_null()) {
        const auto number = material.count();
        if (!number || static_cast<std::size_t>(*number) >= materials_) return bad_gltf("its material does not exist");
        part.material = static_cast<int>(*number);
    }
    if (const auto read = read_variants(primitive, part); !read) return read.error();
    if (corners->empty()) return {};
    const Read used = used_of(*corners, vertices_);
    part.indices = std::move(*corners);
    part.v_axis = YAxis::down;
    return read_attributes(primitive, used, part);
}

Result<void> read_primitives(JsonValue root, GltfBuffers& buffers, DracoTriangles& compressed, bool colors,
                             Mesh& mesh) {
    PrimitiveReader reader(root, buffers, compressed, colors);
    const JsonValue meshes = root["meshes"];
    for (std::size_t m = 0; m < meshes.size(); ++m) {
        const JsonValue primitives = meshes[m]["primitives"];
        for (std::size_t p = 0; p < primitives.size(); ++p) {
            MeshPart part;
            part.name = meshes[m]["name"].text().value_or("");
            part.mesh = static_cast<int>(m);
            part.primitive = static_cast<int>(p);
            auto done = reader.read(primitives[p], part);
            if (done && part.indices.empty()) continue;
            if (done) done = check_part(part);
            if (!done) {
                Error error = done.error();
                if (error.file.empty())
                    error.reason =
                        "mesh " + std::to_string(m) + ", primitive " + std::to_string(p) + ": " + error.reason;
                return error;
            }
            mesh.parts.push_back(std::move(part));
        }
    }
    return {};
}

}  // namespace

bool is_gltf(std::span<const std::byte> head) {
    const std::string_view text = text_of(head);
    const std::size_t mark = text.starts_with(kByteOrderMark) ? kByteOrderMark.size() : 0;
    const std::size_t first = text.find_first_not_of(" \t\r\n", mark);
    return text.starts_with("glTF") || (first != std::string_view::npos && text[first] == '{');
}

namespace {

constexpr std::uint32_t kJson = 0x4e4f534a, kBinary = 0x004e4942;

}  // namespace

std::optional<std::size_t> glb_json_length(std::span<const std::byte> head, std::int64_t size) {
    if (!text_of(head).starts_with("glTF") || head.size() < 20) return std::nullopt;
    const std::uint32_t total = load_u32(head, 8), length = load_u32(head, 12);
    const bool is_sound =
        load_u32(head, 4) == 2 && load_u32(head, 16) == kJson && total >= 20 && total <= size && length <= total - 20;
    return is_sound ? std::optional<std::size_t>(length) : std::nullopt;
}

// GLB: a header of 12 bytes, a chunk of JSON, and perhaps one of bytes (glTF 2.0, 4.4).
Result<GltfChunks> gltf_chunks(std::span<const std::byte> bytes) {
    if (!text_of(bytes).starts_with("glTF")) return GltfChunks{text_of(bytes), {}};
    if (bytes.size() < 20) return bad_gltf("truncated: a GLB file has a header of 20 bytes");
    if (const std::uint32_t version = load_u32(bytes, 4); version != 2)
        return unsupported("its GLB version is " + std::to_string(version) + ", only 2 is supported");
    const std::uint32_t total = load_u32(bytes, 8), length = load_u32(bytes, 12);
    if (total > bytes.size()) {
        return bad_gltf("truncated: its header claims " + std::to_string(total) + " bytes, there are " +
                        std::to_string(bytes.size()));
    }
    if (total < 20 || load_u32(bytes, 16) != kJson) return bad_gltf("its first chunk is not JSON");
    if (length > total - 20) return bad_gltf("truncated: its JSON leaves the file");
    GltfChunks chunks{text_of(bytes.subspan(20, length)), {}};
    const std::span<const std::byte> rest = bytes.subspan(20 + std::size_t{length}, total - 20 - length);
    if (rest.size() < 8 || load_u32(rest, 4) != kBinary) return chunks;
    const std::uint32_t size = load_u32(rest, 0);
    if (size > rest.size() - 8) return bad_gltf("truncated: its binary chunk leaves the file");
    chunks.binary = rest.subspan(8, size);
    return chunks;
}

namespace {

// 1 of "2.1".
int minor_of(std::string_view version) {
    int minor = 0;
    std::from_chars(version.data() + 2, version.data() + version.size(), minor);
    return minor;
}

}  // namespace

Result<void> check_asset(JsonValue root) {
    const std::optional<std::string> version = root["asset"]["version"].text();
    if (!version) return bad_gltf("is JSON, but not glTF: asset.version is missing");
    if (!version->starts_with("2.")) return unsupported("its glTF version is " + *version + ", only 2.x is supported");
    // A file of 2.1 may require 2.1, which the validator accepts, too. No 2.x so far changes triangles.
    const std::string least = root["asset"]["minVersion"].text().value_or("2.0");
    if (!least.starts_with("2.") || minor_of(least) > minor_of(*version))
        return bad_gltf("requires glTF version " + least.substr(0, 20) + ", and is of version " +
                        version->substr(0, 20));
    return check_required_extensions(root);
}

Result<std::vector<std::string>> gltf_buffer_files(std::span<const std::byte> bytes) {
    const auto chunks = gltf_chunks(bytes);
    if (!chunks) return chunks.error();
    const auto document = JsonDocument::parse(chunks->json);
    if (!document) return document.error();
    const JsonValue buffers = document->root()["buffers"];
    std::vector<std::string> files;
    for (std::size_t k = 0; k < buffers.size(); ++k) {
        const std::optional<std::string> uri = buffers[k]["uri"].text();
        if (!uri || is_data_uri(*uri)) continue;
        auto path = path_of_uri(*uri);
        if (!path) return path.error();
        if (std::find(files.begin(), files.end(), *path) == files.end()) files.push_back(std::move(*path));
    }
    return files;
}

Result<Mesh> parse_gltf(JsonValue root, GltfBuffers& buffers, const DecodeDraco& draco, bool colors) {
    if (const auto checked = check_asset(root); !checked) return checked.error();
    Mesh mesh;
    auto nodes = gltf_nodes(root, buffers);
    if (!nodes) return nodes.error();
    mesh.nodes = std::move(*nodes);
    auto compressed = DracoTriangles::decode(root, buffers, draco);
    if (!compressed) return compressed.error();
    if (const auto read = read_primitives(root, buffers, *compressed, colors, mesh); !read) return read.error();
    if (mesh.parts.empty()) return bad_gltf("has no triangles");
    auto materials = gltf_materials(root);
    if (!materials) return materials.error();
    mesh.materials = std::move(*materials);
    mesh.remarks = ignored_extensions(root);
    return mesh;
}

Result<Mesh> parse_gltf(std::span<const std::byte> bytes, const LoadBeside& load, const DecodeDraco& draco,
                        bool colors) {
    const auto chunks = gltf_chunks(bytes);
    if (!chunks) return chunks.error();
    const auto document = JsonDocument::parse(chunks->json);
    if (!document) return document.error();
    GltfBuffers buffers(document->root(), chunks->json.size(), chunks->binary, load);
    return parse_gltf(document->root(), buffers, draco, colors);
}

}  // namespace tex::inline v1
