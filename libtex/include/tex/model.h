// SPDX-License-Identifier: Apache-2.0
// model.h: glTF models with their normal maps: meshes, materials, images.
//
// A glTF material names textures by the part that they play, a slot: normalTexture, baseColorTexture ... A texture
// names an image, which is a file beside the model, or bytes in it.

#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <tex/image_io.h>
#include <tex/mesh.h>
#include <tex/mesh_io.h>
#include <tex/mesh_selection.h>
#include <tex/names.h>
#include <tex/result.h>
#include <tex/texture.h>

#pragma GCC visibility push(default)
namespace tex {

// The slots that hold normals.
enum class NormalSlot { normal, clearcoat_normal };

inline constexpr Named<NormalSlot> kNormalSlotNames[] = {
    {NormalSlot::normal, "normal", "normalTexture"},
    {NormalSlot::clearcoat_normal, "clearcoat-normal", "clearcoatNormalTexture of KHR_materials_clearcoat"},
};

// A slot of a material that uses an image.
struct ImageUse {
    int material = 0;       // an index into Mesh::materials
    std::string slot;       // "baseColorTexture"
    bool is_color = false;  // glTF reads the slot as sRGB colours
};

// An image of a model.
struct ModelImage {
    std::string name;       // as the model calls it, else the name of its file, else "image 3"
    std::string file;       // the path of its file, which need not exist; empty: its bytes are in the model
    std::string mime_type;  // as the model states it; may be empty
    std::vector<std::byte> bytes;
    std::vector<ImageUse> uses;
    std::optional<Error> error;  // why it cannot be read, if the model says enough to know that
};

// A normal map that a material uses.
struct ModelMap {
    int material = 0;  // an index into Mesh::materials
    NormalSlot slot = NormalSlot::normal;
    int image = -1;  // an index into Model::images; -1: none that libtex knows
    int uv_set = 0;
    UvTransform uv_transform = {};
    double scale = 1.0;            // x and y are multiplied by it (normalTexture.scale)
    bool is_double_sided = false;  // the material
};

struct Model {
    std::string file;  // its path
    Mesh mesh;
    std::vector<ModelImage> images;
    std::vector<ModelMap> maps;  // by material, then slot
};

// Whether a file begins as a glTF model does, as text or as GLB. False if it cannot be read; "-" is not looked at.
[[nodiscard]] bool is_model(const std::string& path);

// Reads a model: its meshes as read_mesh(), and the bytes of those images that are inside it and that a normal slot
// uses. Of the sources of a texture, the first that is there counts: KHR_texture_basisu, MSFT_texture_dds,
// EXT_texture_webp, else the texture's own. An image in a file must be in the folder of the model or below it, as
// buffers must.
//
// Errors: those of read_mesh(); unsupported (the file is not glTF; it is "-").
[[nodiscard]] Result<Model> read_model(const std::string& path, const MeshReadOptions& options = {});

// The same without geometry: of the mesh, the materials alone. Errors: those of read_model() that do not come from
// geometry.
[[nodiscard]] Result<Model> read_model_maps(const std::string& path, const MeshReadOptions& options = {});

// The material and the image of a map, as messages name them: "Leather: leather_n.png"; "2 (clearcoat): image 3".
[[nodiscard]] std::string map_name(const Model& model, const ModelMap& map);

// Reads the image of a map. Its content decides how, whatever mime_type says. Errors: those of read_texture(); bad_data
// (the map has no image). They name the image.
[[nodiscard]] Result<Texture> read_map(const Model& model, const ModelMap& map, const ReadOptions& options = {});

// The triangles that the map is on: those of its material, with its UV set and transform.
[[nodiscard]] MeshSelection selection_of(const Model& model, const ModelMap& map);

// The maps of a material, by its name or its number from 0; all maps if `material` is empty. Errors: bad_option (there
// is no such material).
[[nodiscard]] Result<std::vector<ModelMap>> maps_of(const Model& model, const std::string& material);

}  // namespace tex
#pragma GCC visibility pop
