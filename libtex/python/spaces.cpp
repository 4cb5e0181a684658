// SPDX-License-Identifier: Apache-2.0
// Mesh files, tangents, and normal maps from one space to another.

#include <array>
#include <cmath>

#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include "meshes.h"
#include "modules.h"
#include "running.h"
#include "values.h"

namespace tex::python {

template <class F>
void each_field(MeshReadOptions& o, F& f) {
    f("reader", o.reader);
    f("max_bytes", o.max_bytes);
    f("colors", o.colors);
    f("images", o.images);
}

template <class F>
void each_field(MeshSelection& o, F& f) {
    f("material", o.material);
    f("primitive", o.primitive);
    f("node", o.node);
    f("in_scene", o.in_scene);
    f("uv_set", o.uv_set);
    f("tangents", o.tangents);
}

namespace {

constexpr const char* kMeshPath = "str | PathLike[str]";
constexpr const char* kTangentRows = "NDArray[np.float32]";

struct DecoderKeyword {
    Decoder decoder = Decoder::gltf;
};

template <class F>
void each_field(DecoderKeyword& o, F& f) {
    f("decoder", o.decoder);
}

struct TwoDecoders {
    Decoder source = Decoder::gltf, target = Decoder::gltf;
};

template <class F>
void each_field(TwoDecoders& o, F& f) {
    f("source_decoder", o.source);
    f("target_decoder", o.target);
}

// A dict of Mesh.nodes, or its matrix.
MeshNode node_from(py::handle from) {
    const py::object matrix =
        py::isinstance<py::dict>(from) ? py::object(from["to_scene"]) : py::reinterpret_borrow<py::object>(from);
    const auto array = py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(matrix);
    if (!array) {
        PyErr_Clear();
        raise_type("node", "a dict of Mesh.nodes, or a matrix", from);
    }
    MeshNode node;
    need(array.ndim() == 2 && array.shape(0) == 3 && array.shape(1) == 4, "node",
         "the matrix must have 3 rows and 4 columns");
    std::copy_n(array.data(), node.to_scene.size(), node.to_scene.begin());
    return node;
}

py::dict facts_of(const ModelImage& image) {
    py::list uses;
    for (const ImageUse& use : image.uses) uses.append(py::make_tuple(use.material, str_of(use.slot), use.is_color));
    py::dict facts;
    facts["name"] = str_of(image.name);
    facts["file"] = str_of(image.file);
    facts["mime_type"] = str_of(image.mime_type);
    facts["bytes"] = py::bytes(reinterpret_cast<const char*>(image.bytes.data()), image.bytes.size());
    facts["uses"] = uses;
    facts["error"] = image.error ? py::object(str_of(image.error->reason)) : py::none();
    return facts;
}

py::dict facts_of(const Model& model, const ModelMap& map) {
    py::dict facts;
    facts["name"] = str_of(map_name(model, map));
    facts["material"] = map.material;
    facts["slot"] = str_of(std::string(name_of(kNormalSlotNames, map.slot)));
    facts["image"] = map.image < 0 ? py::none() : py::object(py::int_(map.image));
    facts["uv_set"] = map.uv_set;
    facts["uv_transform"] = transform_of(map.uv_transform);
    facts["scale"] = map.scale;
    facts["is_double_sided"] = map.is_double_sided;
    return facts;
}

void add_models(Module& module) {
    module.verb<MeshReadOptions>(
        "read_model", {{"path", kMeshPath}}, "dict[str, Any]",
        "A dict: `mesh`, a Mesh; `images`, a list of dicts with the fields of ModelImage, where a use is a tuple "
        "(material, slot, is_color); `maps`, a list of dicts with the fields of ModelMap, and `name`.",
        [](Call& call, MeshReadOptions& options) -> py::object {
            const std::string path = path_from(call["path"], "path");
            Model model = value_of(without_gil([&] { return read_model(path, options); }));
            py::list images, maps;
            for (const ModelImage& image : model.images) images.append(facts_of(image));
            for (const ModelMap& map : model.maps) maps.append(facts_of(model, map));
            py::dict facts;
            facts["mesh"] = py::cast(std::make_shared<Mesh>(std::move(model.mesh)));
            facts["images"] = images;
            facts["maps"] = maps;
            return facts;
        });
}

void add_mesh_files(Module& module) {
    module.verb<MeshReadOptions>(
        "read_mesh", {{"path", kMeshPath}}, "Mesh", "Arrays of its parts are not copied.",
        [](Call& call, MeshReadOptions& options) -> py::object {
            const std::string path = path_from(call["path"], "path");
            return py::cast(std::make_shared<Mesh>(value_of(without_gil([&] { return read_mesh(path, options); }))));
        });
    module.verb<MeshReadOptions>("mesh_files", {{"path", kMeshPath}}, "list[str]", "",
                                 [](Call& call, MeshReadOptions& options) -> py::object {
                                     const std::string path = path_from(call["path"], "path");
                                     return strs_of(value_of(without_gil([&] { return mesh_files(path, options); })));
                                 });
}

void add_parts(Module& module) {
    module.verb<>(
        "in_scene", {{"part", "MeshPart"}, {"node", "dict[str, Any] | ArrayLike"}}, "MeshPart",
        "`node` is a dict of Mesh.nodes, or a matrix, an array (3, 4).", [](Call& call) -> py::object {
            const MeshPart& part = part_from(call["part"], "part");
            const MeshNode node = node_from(call["node"]);
            return py::cast(std::make_shared<MeshPart>(value_of(without_gil([&] { return in_scene(part, node); }))));
        });
    module.verb<Running>(
        "make_tangents", {{"part", "MeshPart"}, {"method", "str", "'mikktspace'"}, {"uv_set", "int", "0"}},
        kTangentRows, "An array (corners, 4), where `corners` are three for each triangle.",
        [](Call& call, Running& running) -> py::object {
            const MeshPart& part = part_from(call["part"], "part");
            const auto method =
                call.has("method") ? Convert<TangentMethod>::from(call["method"], "method") : TangentMethod::mikktspace;
            const int set = call.has("uv_set") ? Convert<int>::from(call["uv_set"], "uv_set") : 0;
            need(set >= 0, "uv_set", "must be 0 or more");
            return tangents_of(running.run([&](const Execution& e) { return make_tangents(part, method, set, e); }));
        });
    module.verb<>("stored_tangents", {{"part", "MeshPart"}}, kTangentRows, "An array (corners, 4).",
                  [](Call& call) -> py::object {
                      const MeshPart& part = part_from(call["part"], "part");
                      return tangents_of(value_of(without_gil([&] { return stored_tangents(part); })));
                  });
    module.verb<MeshSelection, Running>("select_part", {{"mesh", "Mesh"}}, "SelectedPart",
                                        "What to give to to_object_space(), refit(), check() and preview().",
                                        [](Call& call, MeshSelection& selection, Running& running) -> py::object {
                                            const Mesh& mesh = mesh_from(call["mesh"], "mesh");
                                            return py::cast(std::make_shared<SelectedPart>(running.run(
                                                [&](const Execution& e) { return select_part(mesh, selection, e); })));
                                        });
    module.verb<>(
        "in_tile", {{"selected", "SelectedPart"}, {"tile", "int"}}, "SelectedPart", "", [](Call& call) -> py::object {
            const SelectedPart& selected = selected_from(call["selected"], "selected");
            const int tile = Convert<int>::from(call["tile"], "tile");
            need(tile >= 1001, "tile", "must be 1001 or more");
            return py::cast(
                std::make_shared<SelectedPart>(value_of(without_gil([&] { return in_tile(selected, tile); }))));
        });
    module.verb<>("tiles_of", {{"selected", "SelectedPart"}}, "dict[str, Any]", "A dict of the fields of UvTiles.",
                  [](Call& call) -> py::object {
                      const SelectedPart& selected = selected_from(call["selected"], "selected");
                      const UvTiles found = value_of(without_gil([&] { return tiles_of(selected); }));
                      py::dict result;
                      result["tiles"] = found.tiles;
                      result["outside"] = found.outside;
                      result["crossing"] = found.crossing;
                      return result;
                  });
    module.verb<>("decoder_kind", {{"decoder", "str"}}, "str", "'per-vertex', 'per-fragment' or 'normalized'.",
                  [](Call& call) -> py::object {
                      return word_of(decoder_kind(Convert<Decoder>::from(call["decoder"], "decoder")));
                  });
}

py::dict dict_of(ConvertedMap converted) {
    const Extent extent = converted.coverage.extent();
    py::array_t<std::uint8_t> coverage({py::ssize_t{extent.height}, py::ssize_t{extent.width}});
    for (int j = 0; j < extent.height; ++j) {
        const Coverage* const row = converted.coverage.row(j);
        for (int i = 0; i < extent.width; ++i) *coverage.mutable_data(j, i) = static_cast<std::uint8_t>(row[i]);
    }
    py::dict result;
    result["map"] = array_of(std::move(converted.map));
    result["coverage"] = coverage;
    result["covered"] = converted.covered;
    result["overlaps"] = converted.overlaps;
    result["moved"] = converted.moved;
    result["backward"] = converted.backward;
    result["singular"] = converted.singular;
    result["unmatched"] = converted.unmatched;
    return result;
}

constexpr const char* kConverted =
    "A dict of the fields of ConvertedMap; 'coverage' is an array (height, width) of 0 (none), 1 (padding), 2 (gutter) "
    "and 3 (triangle).";

using Conversion = Result<ConvertedMap>(const NormalMap&, const TangentSpace&, const ConvertOptions&, const Execution&);

void add_conversion(Module& module, const char* name, Conversion* convert) {
    module.verb<DecoderKeyword, ConvertOptions, Running>(
        name, {{"n", kMapSource}, {"space", "SelectedPart"}}, "dict[str, Any]", kConverted,
        [convert](Call& call, DecoderKeyword& keyword, ConvertOptions& options, Running& running) -> py::object {
            const NormalMap map = map_from(call["n"], "n");
            const TangentSpace space = space_of(selected_from(call["space"], "space"), keyword.decoder);
            return dict_of(running.run([&](const Execution& e) { return convert(map, space, options, e); }));
        });
}

}  // namespace

void add_spaces(Module& module) {
    add_mesh_files(module);
    add_models(module);
    add_parts(module);
    add_conversion(module, "to_object_space", to_object_space);
    add_conversion(module, "to_tangent_space", to_tangent_space);
    module.verb<TwoDecoders, ConvertOptions, Running>(
        "refit", {{"n", kMapSource}, {"source", "SelectedPart"}, {"target", "SelectedPart"}}, "dict[str, Any]",
        kConverted, [](Call& call, TwoDecoders& decoders, ConvertOptions& options, Running& running) -> py::object {
            const NormalMap map = map_from(call["n"], "n");
            const TangentSpace source = space_of(selected_from(call["source"], "source"), decoders.source);
            const TangentSpace target = space_of(selected_from(call["target"], "target"), decoders.target);
            return dict_of(running.run([&](const Execution& e) { return refit(map, source, target, options, e); }));
        });
}

}  // namespace tex::python
