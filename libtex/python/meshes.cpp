// SPDX-License-Identifier: Apache-2.0
#include "meshes.h"

#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include "arrays.h"
#include "modules.h"
#include "pickling.h"
#include "running.h"

namespace tex::python {
namespace {

constexpr const char* kRows = "NDArray[np.float32]";

template <class T>
constexpr py::ssize_t kColumns = static_cast<py::ssize_t>(sizeof(T) / sizeof(float));

// A read-only array (elements, columns) over the memory of `owner`.
template <class T>
py::array rows_of(const std::vector<T>& rows, py::handle owner) {
    const auto count = static_cast<py::ssize_t>(rows.size());
    py::array array(py::dtype::of<float>(), {count, kColumns<T>}, {py::ssize_t{sizeof(T)}, py::ssize_t{sizeof(float)}},
                    rows.empty() ? nullptr : &rows.data()->x, owner);
    array.attr("flags").attr("writeable") = false;
    return array;
}

template <class T>
std::vector<T> rows_from(py::handle from, const std::string& name) {
    const auto array = py::array_t<float, py::array::c_style | py::array::forcecast>::ensure(
        any_array_from(from, name, "an array of numbers"));
    if (!array) {
        PyErr_Clear();
        raise_type(name, "an array of numbers", from);
    }
    need(array.ndim() == 2 && array.shape(1) == kColumns<T>, name,
         fmt::format("expected an array of shape (elements, {}), got {}", kColumns<T>,
                     std::string(py::str(py::object(array.attr("shape"))))));
    std::vector<T> rows(static_cast<std::size_t>(array.shape(0)));
    const float* number = array.data();
    for (T& row : rows) {
        row.x = *number++;
        row.y = *number++;
        if constexpr (requires { row.z; }) row.z = *number++;
        if constexpr (requires { row.w; }) row.w = *number++;
    }
    return rows;
}

// Vertices of triangles, (triangles, 3), or a flat list of them.
std::vector<std::uint32_t> indices_from(py::handle from) {
    const py::array given = py::array::ensure(from);
    if (!given || (given.dtype().kind() != 'i' && given.dtype().kind() != 'u')) {
        PyErr_Clear();
        raise_type("indices", "an array of integers", from);
    }
    const py::array_t<std::int64_t, py::array::c_style | py::array::forcecast> array(given);
    need(array.ndim() == 1 || (array.ndim() == 2 && array.shape(1) == 3), "indices",
         "expected an array of shape (triangles, 3)");
    std::vector<std::uint32_t> indices;
    for (const std::int64_t* index = array.data(); index != array.data() + array.size(); ++index) {
        need(*index >= 0 && *index <= std::numeric_limits<std::uint32_t>::max(), "indices",
             "must be 0 or more, and less than the number of vertices");
        indices.push_back(static_cast<std::uint32_t>(*index));
    }
    return indices;
}

// One set, (vertices, 2), or a sequence of sets.
std::vector<std::vector<Float2>> uv_sets_from(const py::object& from) {
    const py::array array = py::array::ensure(from);
    if (!array) PyErr_Clear();  // sets of different sizes, of which check_part() complains
    if (array && array.ndim() == 2) return {rows_from<Float2>(from, "uvs")};
    if (!py::isinstance<py::sequence>(from) && !py::isinstance<py::array>(from))
        raise_type("uvs", "an array of numbers or a list of such arrays", from);
    std::vector<std::vector<Float2>> sets;
    for (const py::handle set : from) sets.push_back(rows_from<Float2>(set, fmt::format("uvs[{}]", sets.size())));
    return sets;
}

MeshPart make_part(Call& call) {
    MeshPart part;
    if (call.has("name")) part.name = text_from(call["name"], "name");
    if (call.has("v_axis")) part.v_axis = Convert<YAxis>::from(call["v_axis"], "v_axis");
    part.positions = rows_from<Float3>(call["positions"], "positions");
    part.indices = indices_from(call["indices"]);
    if (call.has("normals")) part.normals = rows_from<Float3>(call["normals"], "normals");
    if (call.has("tangents")) part.tangents = rows_from<Float4>(call["tangents"], "tangents");
    if (call.has("uvs")) part.uvs = uv_sets_from(call["uvs"]);
    if (call.has("colors")) part.colors = rows_from<Float3>(call["colors"], "colors");
    value_of(check_part(part));
    return part;
}

py::array indices_of(const py::object& self) {
    const auto& part = self.cast<const MeshPart&>();
    py::array array(py::dtype::of<std::uint32_t>(), {static_cast<py::ssize_t>(part.triangles()), py::ssize_t{3}},
                    part.indices.data(), self);
    array.attr("flags").attr("writeable") = false;
    return array;
}

py::list uvs_of(const py::object& self) {
    py::list sets;
    for (const std::vector<Float2>& set : self.cast<const MeshPart&>().uvs) sets.append(rows_of(set, self));
    return sets;
}

// None if there are no elements.
template <class T>
py::object some_rows_of(const std::vector<T>& rows, py::handle owner) {
    if (rows.empty()) return py::none();
    return rows_of(rows, owner);
}

void add_part(Module& module) {
    Class<MeshPart>(module, "MeshPart", "Triangles that share a material. Cannot change.")
        .constructor({{"positions", "ArrayLike"},
                      {"indices", "ArrayLike"},
                      {"normals", "ArrayLike | None", "None"},
                      {"uvs", "ArrayLike | Sequence[ArrayLike] | None", "None"},
                      {"tangents", "ArrayLike | None", "None"},
                      {"v_axis", "str", "'up'"},
                      {"name", "str", "''"},
                      {"colors", "ArrayLike | None", "None"}},
                     2, make_part)
        .property("name", "str", "Of the mesh or object; may be empty.",
                  [](const MeshPart& p) { return str_of(p.name); })
        .property("mesh", "int", "Parts of the same mesh have the same number.",
                  [](const MeshPart& p) { return p.mesh; })
        .property("primitive", "int", "The number of the part in its mesh.",
                  [](const MeshPart& p) { return p.primitive; })
        .property("material", "int", "An index into Mesh.materials, or -1.",
                  [](const MeshPart& p) { return p.material; })
        .property("v_axis", "str", "The direction of v: 'up' or 'down'.",
                  [](const MeshPart& p) { return word_of(p.v_axis); })
        .property("positions", kRows, "(vertices, 3), read-only, as all arrays here.",
                  [](const py::object& self) { return rows_of(self.cast<const MeshPart&>().positions, self); })
        .property("normals", "NDArray[np.float32] | None", "(vertices, 3), as stored.",
                  [](const py::object& self) { return some_rows_of(self.cast<const MeshPart&>().normals, self); })
        .property("tangents", "NDArray[np.float32] | None", "(vertices, 4): x, y, z, w, as stored.",
                  [](const py::object& self) { return some_rows_of(self.cast<const MeshPart&>().tangents, self); })
        .property("uvs", "list[NDArray[np.float32]]", "The sets of UVs, (vertices, 2) each.", uvs_of)
        .property("indices", "NDArray[np.uint32]", "(triangles, 3): the vertices of each triangle.", indices_of)
        .property("colors", "NDArray[np.float32] | None", "(vertices, 3): red, green and blue, as stored.",
                  [](const py::object& self) { return some_rows_of(self.cast<const MeshPart&>().colors, self); })
        .property("quads", "list[int]", "Triangles that, each with the next one, were a quad in the file.",
                  [](const MeshPart& p) { return p.quads; })
        .property("variants", "list[int]", "Other materials that the part can have (KHR_materials_variants).",
                  [](const MeshPart& p) { return p.variants; })
        .method("__repr__", "(self) -> str",
                [](const MeshPart& p) {
                    return str_of(fmt::format("<tex.MeshPart {}: {} triangles>", shown_text(p.name), p.triangles()));
                })
        .copies()
        .finish();
}

py::list parts_of(const py::object& self) {
    py::list parts;
    for (const MeshPart& part : self.cast<const Mesh&>().parts)
        parts.append(py::cast(part, py::return_value_policy::reference_internal, self));
    return parts;
}

}  // namespace

py::dict transform_of(const UvTransform& transform) {
    py::dict facts;
    facts["offset"] = py::make_tuple(transform.offset_x, transform.offset_y);
    facts["rotation"] = transform.rotation;
    facts["scale"] = py::make_tuple(transform.scale_x, transform.scale_y);
    return facts;
}

namespace {

py::list materials_of(const Mesh& mesh) {
    py::list materials;
    for (const MeshMaterial& material : mesh.materials) {
        py::dict facts;
        facts["name"] = str_of(material.name);
        facts["normal_map"] = str_of(material.normal_map);
        facts["uv_set"] = material.uv_set;
        facts["has_normal_map"] = material.has_normal_map;
        facts["uv_transform"] = transform_of(material.uv_transform);
        facts["mixed_transforms"] = material.mixed_transforms;
        facts["alpha_mode"] = str_of(std::string(name_of(kAlphaModeNames, material.alpha_mode)));
        facts["alpha_cutoff"] = material.alpha_cutoff;
        facts["alpha"] = material.alpha;
        materials.append(facts);
    }
    return materials;
}

py::list nodes_of(const Mesh& mesh) {
    py::list nodes;
    for (const MeshNode& node : mesh.nodes) {
        py::dict facts;
        facts["name"] = str_of(node.name);
        facts["mesh"] = node.mesh;
        facts["to_scene"] = py::array_t<double>({3, 4}, node.to_scene.data());  // a copy
        nodes.append(facts);
    }
    return nodes;
}

void add_mesh(Module& module) {
    Class<Mesh>(module, "Mesh", "The contents of a mesh file, or parts that were made here.")
        .constructor({{"parts", "Sequence[MeshPart]"}}, 1,
                     [](Call& call) {
                         const py::object given = call["parts"];
                         if (PySequence_Check(given.ptr()) == 0) raise_type("parts", "a list of MeshPart", given);
                         Mesh mesh;
                         for (const py::handle part : given) mesh.parts.push_back(part_from(part, "parts"));
                         need(!mesh.parts.empty(), "parts", "there is no part");
                         return mesh;
                     })
        .property("parts", "list[MeshPart]", "Each is stored once, however many nodes show it.", parts_of)
        .property("materials", "list[dict[str, Any]]", "The fields of MeshMaterial.", materials_of)
        .property("nodes", "list[dict[str, Any]]", "The fields of MeshNode; 'to_scene' is an array (3, 4).", nodes_of)
        .property("remarks", "list[str]", "What was left out and may matter.",
                  [](const Mesh& mesh) { return strs_of(mesh.remarks); })
        .method("__repr__", "(self) -> str",
                [](const Mesh& mesh) {
                    return fmt::format("<tex.Mesh: {} parts, {} materials, {} nodes>", mesh.parts.size(),
                                       mesh.materials.size(), mesh.nodes.size());
                })
        .copies()
        .finish();
    Class<SelectedPart>(module, "SelectedPart", "Joined parts that share a map, with a tangent for each corner.")
        .constructor({{"part", "MeshPart"}, {"tangents", "ArrayLike"}}, 2,
                     [](Call& call) {
                         SelectedPart selected;
                         selected.part = part_from(call["part"], "part");
                         selected.tangents = tangents_from(call["tangents"], "tangents");
                         need(selected.tangents.size() == selected.part.indices.size(), "tangents",
                              fmt::format("there must be {}, one for each corner of a triangle, got {}",
                                          selected.part.indices.size(), selected.tangents.size()));
                         return selected;
                     })
        .property("part", "MeshPart", "The parts, joined: one set of UVs.",
                  [](const py::object& self) {
                      return py::cast(self.cast<const SelectedPart&>().part,
                                      py::return_value_policy::reference_internal, self);
                  })
        .property("tangents", kRows, "(corners, 4), read-only.",
                  [](const py::object& self) { return rows_of(self.cast<const SelectedPart&>().tangents, self); })
        .property("source", "str", "Where they come from: 'file', 'mikktspace' or 'meshopt'.",
                  [](const SelectedPart& s) { return word_of(s.source); })
        .property("has_normal_map", "bool", "The material has a normal map.",
                  [](const SelectedPart& s) { return s.has_normal_map; })
        .property("pieces", "list[dict[str, Any]]",
                  "Where its parts begin: 'name', 'material', and 'triangle', the first one.",
                  [](const SelectedPart& s) {
                      py::list pieces;
                      for (const SelectedPiece& piece : s.pieces) {
                          py::dict one;
                          one["name"] = str_of(piece.name);
                          one["material"] = str_of(piece.material);
                          one["triangle"] = piece.triangle;
                          pieces.append(std::move(one));
                      }
                      return pieces;
                  })
        .property("has_tangents", "bool", "Every part has stored tangents.",
                  [](const SelectedPart& s) { return s.has_tangents; })
        .property("rest", "MeshPart | None", "What in_tile() left out, for transfer(around=...).",
                  [](const py::object& self) -> py::object {
                      const MeshPart& rest = self.cast<const SelectedPart&>().rest;
                      if (rest.indices.empty()) return py::none();
                      return py::cast(rest, py::return_value_policy::reference_internal, self);
                  })
        .property("has_transform", "bool", "UVs were moved: they are not those of the file.",
                  [](const SelectedPart& s) { return s.has_transform; })
        .property("remarks", "list[str]", "Those of the mesh, and what the choice left out.",
                  [](const SelectedPart& s) { return strs_of(s.remarks); })
        .copies()
        .finish();
}

template <class T>
const T& instance(py::handle from, std::string_view name, const char* type) {
    if (!py::isinstance<T>(from)) raise_type(name, type, from);
    return from.cast<const T&>();
}

}  // namespace

const Mesh& mesh_from(py::handle from, std::string_view name) { return instance<Mesh>(from, name, "tex.Mesh"); }
const MeshPart& part_from(py::handle from, std::string_view name) {
    return instance<MeshPart>(from, name, "tex.MeshPart");
}
const SelectedPart& selected_from(py::handle from, std::string_view name) {
    return instance<SelectedPart>(from, name, "tex.SelectedPart");
}

py::array tangents_of(const std::vector<Float4>& tangents) {
    py::array_t<float> array({static_cast<py::ssize_t>(tangents.size()), py::ssize_t{4}},
                             tangents.empty() ? nullptr : &tangents.data()->x);
    return array;
}

std::vector<Float4> tangents_from(py::handle from, std::string_view name) {
    std::vector<Float4> tangents = rows_from<Float4>(from, std::string(name));
    for (const Float4& t : tangents) {
        need(std::isfinite(t.x) && std::isfinite(t.y) && std::isfinite(t.z) && std::isfinite(t.w), name,
             "some values are infinite or NaN");
    }
    return tangents;
}

TangentSpace space_of(const SelectedPart& selected, Decoder decoder) {
    return {selected.part, selected.tangents, 0, decoder};
}

void add_meshes(Module& module) {
    add_part(module);
    add_mesh(module);
}

}  // namespace tex::python
