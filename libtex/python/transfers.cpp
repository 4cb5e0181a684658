// SPDX-License-Identifier: Apache-2.0
// Maps of a low mesh from a high one.

#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <list>
#include <string>

#include "meshes.h"
#include "modules.h"
#include "running.h"
#include "values.h"

namespace tex::python {

template <>
struct Words<RayMode> {
    static constexpr const auto& kRows = kRayModeNames;
};
template <>
struct Words<HitChoice> {
    static constexpr const auto& kRows = kHitChoiceNames;
};

// A number, "5%" or "auto".
template <>
struct Convert<Reach> {
    static Reach from(py::handle given, std::string_view name) {
        if (!py::isinstance<py::str>(given)) return {Reach::Unit::absolute, number_from(given, name)};
        const std::string text = text_from(given, name);
        if (text == "auto") return {};
        const char* const wanted = "must be a number, a text such as '5%', or 'auto'";
        need(text.ends_with('%'), name, wanted);
        const py::object number = py::str(text.substr(0, text.size() - 1));
        const py::object value = py::reinterpret_steal<py::object>(PyFloat_FromString(number.ptr()));
        if (!value) PyErr_Clear();
        need(static_cast<bool>(value), name, wanted);
        return {Reach::Unit::percent, number_from(value, name)};
    }
    static std::string shown(const Reach& reach) {
        switch (reach.unit) {
            case Reach::Unit::automatic: return shown_text("auto");
            case Reach::Unit::percent: return shown_text(fmt::format("{}%", reach.value));
            case Reach::Unit::absolute: break;
        }
        return fmt::format("{}", reach.value);
    }
    static std::string type() { return "float | str"; }
};

namespace {

struct LowDecoder {
    Decoder decoder = Decoder::gltf;
};

template <class F>
void each_field(LowDecoder& o, F& f) {
    f("decoder", o.decoder);
}

// TransferInputs, as Python gives them.
struct GivenInputs {
    py::object around = py::none();
    py::object cage = py::none(), skew = py::none(), offset = py::none();
    py::object low_groups = py::none(), high_groups = py::none(), high_ids = py::none(), high_details = py::none();
    py::object high_places = py::none();
};

template <class F>
void each_field(GivenInputs& o, F& f) {
    f("around", o.around, "MeshPart | None");
    f("cage", o.cage, "MeshPart | None");
    f("skew", o.skew, "ArrayLike | None");
    f("offset", o.offset, "ArrayLike | None");
    f("low_groups", o.low_groups, "Sequence[int] | None");
    f("high_groups", o.high_groups, "Sequence[int] | None");
    f("high_ids", o.high_ids, "Sequence[int] | None");
    f("high_details", o.high_details, "Sequence[dict[str, Any] | None] | None");
    f("high_places", o.high_places, "Sequence[dict[str, Any]] | None");
}

std::vector<py::object> sequence_from(py::handle given, std::string_view name, std::string_view wanted) {
    const bool is_array = py::isinstance<py::array>(given);
    if (py::isinstance<py::str>(given) || (!py::isinstance<py::sequence>(given) && !is_array))
        raise_type(name, wanted, given);
    std::vector<py::object> items;
    for (const py::handle item : given) items.push_back(py::reinterpret_borrow<py::object>(item));
    return items;
}

std::vector<int> numbers_from(py::handle given, std::string_view name) {
    std::vector<int> numbers;
    if (given.is_none()) return numbers;
    for (const py::object& item : sequence_from(given, name, "a sequence of integers"))
        numbers.push_back(Convert<int>::from(item, name));
    return numbers;
}

PartPlace place_from(const py::object& item) {
    PartPlace place;
    if (!py::isinstance<py::dict>(item)) raise_type("high_places", "a dict for each place", item);
    for (const auto& [key, value] : item.cast<py::dict>()) {
        const std::string name = text_from(key, "high_places");
        if (name == "part") {
            const std::int64_t part = Convert<std::int64_t>::from(value, name);
            need(part >= 0, name, "must be 0 or more");
            place.part = static_cast<std::size_t>(part);
        } else if (name == "name") {
            place.name = text_from(value, name);
        } else if (name == "to_scene") {
            const char* const wanted = "must be 12 numbers, the rows of a 3x4 matrix";
            const std::vector<py::object> numbers = sequence_from(value, name, "12 numbers");
            need(numbers.size() == place.to_scene.size(), name, wanted);
            for (std::size_t k = 0; k < numbers.size(); ++k) place.to_scene[k] = number_from(numbers[k], name);
        } else {
            raise_value("high_places", shown_text(name) + " must be one of 'part', 'name', 'to_scene'");
        }
    }
    return place;
}

// TransferInputs with what they refer to.
struct OwnInputs {
    TransferInputs inputs;
    Plane<float> skew, offset;
    std::list<Plane<float>> alphas;
    std::list<NormalMap> maps;
    std::list<std::vector<Float4>> tangents;
    std::list<Picture> pictures;

    explicit OwnInputs(const GivenInputs& given) {
        if (!given.around.is_none()) inputs.around = &part_from(given.around, "around");
        if (!given.cage.is_none()) inputs.cage = &part_from(given.cage, "cage");
        if (!given.skew.is_none()) inputs.skew = &(skew = plane_from(given.skew, "skew"));
        if (!given.offset.is_none()) inputs.offset = &(offset = plane_from(given.offset, "offset"));
        inputs.low_groups = numbers_from(given.low_groups, "low_groups");
        inputs.high_groups = numbers_from(given.high_groups, "high_groups");
        inputs.high_ids = numbers_from(given.high_ids, "high_ids");
        if (!given.high_places.is_none()) {
            for (const py::object& item : sequence_from(given.high_places, "high_places", "a sequence of dicts"))
                inputs.high_places.push_back(place_from(item));
        }
        if (given.high_details.is_none()) return;
        for (const py::object& item : sequence_from(given.high_details, "high_details", "a sequence of dicts"))
            add_detail(item);
    }
    OwnInputs(const OwnInputs&) = delete;
    OwnInputs& operator=(const OwnInputs&) = delete;

private:
    void add_detail(const py::object& item) {
        HighDetail& detail = inputs.high_details.emplace_back();
        if (item.is_none()) return;
        if (!py::isinstance<py::dict>(item)) raise_type("high_details", "a dict or None for each part", item);
        for (const auto& [key, value] : item.cast<py::dict>()) {
            const std::string name = text_from(key, "high_details");
            if (name == "normals") {
                detail.normals = &maps.emplace_back(map_from(value, name));
            } else if (name == "tangents") {
                detail.tangents = &tangents.emplace_back(tangents_from(value, name));
            } else if (name == "decoder") {
                detail.decoder = Convert<Decoder>::from(value, name);
            } else if (name == "color") {
                detail.color = &*pictures.emplace_back(value, name);
            } else if (name == "uv_set") {
                detail.uv_set = Convert<int>::from(value, name);
            } else if (name == "alpha") {
                detail.alpha = &alphas.emplace_back(plane_from(value, name));
            } else if (name == "alpha_cutoff") {
                detail.alpha_cutoff = Convert<float>::from(value, name);
            } else if (name == "alpha_uv_set") {
                detail.alpha_uv_set = Convert<int>::from(value, name);
            } else {
                raise_value("high_details", shown_text(name) +
                                                " must be one of 'normals', 'tangents', 'decoder', 'color', 'uv_set', "
                                                "'alpha', 'alpha_cutoff', 'alpha_uv_set'");
            }
        }
    }
};

// One part, the parts of a mesh, or a sequence of parts. Copied, because parts may be shared with other verbs.
std::vector<MeshPart> parts_from(py::handle given, std::string_view name) {
    if (py::isinstance<MeshPart>(given)) return {part_from(given, name)};
    if (py::isinstance<Mesh>(given)) return mesh_from(given, name).parts;
    std::vector<MeshPart> parts;
    for (const py::object& item : sequence_from(given, name, "a tex.MeshPart, a tex.Mesh or a sequence of parts"))
        parts.push_back(part_from(item, name));
    return parts;
}

template <class T, class Value>
py::array table_of(const Plane<T>& plane) {
    const auto [width, height] = plane.extent();
    py::array_t<Value> array({py::ssize_t{height}, py::ssize_t{width}});
    for (int j = 0; j < height; ++j) {
        const T* const row = plane.row(j);
        for (int i = 0; i < width; ++i) *array.mutable_data(j, i) = static_cast<Value>(row[i]);
    }
    return array;
}

void add_maps(py::dict& result, TransferredMaps& maps) {
    const auto plane = [&](const char* name, Plane<float>& of) {
        result[name] = of.empty() ? py::object(py::none()) : py::object(array_of(std::move(of)));
    };
    const auto vectors = [&](const char* name, NormalMap& of) {
        result[name] = of.x.empty() ? py::object(py::none()) : py::object(array_of(std::move(of)));
    };
    result["origin"] = table_of<TexelOrigin, std::uint8_t>(maps.origin);
    result["ids"] =
        maps.ids.empty() ? py::object(py::none()) : py::object(table_of<std::int32_t, std::int32_t>(maps.ids));
    vectors("map", maps.map);
    vectors("object", maps.object);
    vectors("bent", maps.bent);
    plane("heights", maps.heights);
    plane("occlusion", maps.occlusion);
    plane("thickness", maps.thickness);
    NormalMap position;
    position.x = std::move(maps.position[0]);
    position.y = std::move(maps.position[1]);
    position.z = std::move(maps.position[2]);
    vectors("position", position);
    for (const auto& [name, image] : {std::pair{"color", &maps.color}, std::pair{"vertex_color", &maps.vertex_color}})
        result[name] = image->planes.empty() ? py::object(py::none()) : object_of(std::move(*image));
}

py::dict dict_of(TransferredMaps maps) {
    py::dict result;
    add_maps(result, maps);
    result["covered"] = maps.covered;
    result["missed"] = maps.missed;
    result["overlaps"] = maps.overlaps;
    result["moved"] = maps.moved;
    result["backward"] = maps.backward;
    result["singular"] = maps.singular;
    result["behind"] = maps.behind;
    result["rays"] = maps.rays;
    result["front"] = maps.front;
    result["back"] = maps.back;
    result["diagonal"] = maps.diagonal;
    result["lowest"] = maps.lowest;
    result["highest"] = maps.highest;
    result["thinnest"] = maps.thinnest;
    result["thickest"] = maps.thickest;
    result["needed_front"] = maps.needed_front;
    result["needed_back"] = maps.needed_back;
    result["hopeless"] = maps.hopeless;
    return result;
}

std::vector<std::string> names_from(py::handle given, std::string_view name) {
    std::vector<std::string> names;
    for (const py::object& item : sequence_from(given, name, "a sequence of str"))
        names.push_back(text_from(item, name));
    return names;
}

std::size_t most_from(Call& call) {
    if (!call.has("most")) return kMaxCopied;
    return static_cast<std::size_t>(std::max<std::int64_t>(0, Convert<std::int64_t>::from(call["most"], "most")));
}

void add_helpers(Module& module) {
    module.verb<>("parts_in_scene", {{"mesh", "Mesh"}, {"most", "int", std::to_string(kMaxCopied)}}, "list[MeshPart]",
                  "", [](Call& call) -> py::object {
                      const Mesh& mesh = mesh_from(call["mesh"], "mesh");
                      const std::size_t most = most_from(call);
                      py::list list;
                      for (MeshPart& part : value_of(without_gil([&] { return parts_in_scene(mesh, most); })))
                          list.append(py::cast(std::make_shared<MeshPart>(std::move(part))));
                      return list;
                  });
    module.verb<>("places_in_scene", {{"mesh", "Mesh"}, {"most", "int", std::to_string(kMaxCopied)}},
                  "tuple[list[MeshPart], list[dict[str, Any]]]",
                  "The parts, and a dict of the fields of PartPlace for each place.", [](Call& call) -> py::object {
                      const Mesh& mesh = mesh_from(call["mesh"], "mesh");
                      SceneParts scene =
                          value_of(without_gil([&, most = most_from(call)] { return places_in_scene(mesh, most); }));
                      py::list parts, places;
                      for (MeshPart& part : scene.parts)
                          parts.append(py::cast(std::make_shared<MeshPart>(std::move(part))));
                      for (const PartPlace& place : scene.places) {
                          py::dict item;
                          item["part"] = place.part;
                          item["name"] = strs_of({place.name})[0];
                          item["to_scene"] = place.to_scene;
                          places.append(item);
                      }
                      return py::make_tuple(parts, places);
                  });
    module.verb<>("match_names", {{"low", "Sequence[str]"}, {"high", "Sequence[str]"}}, "dict[str, Any]",
                  "A dict of the fields of MatchedNames.", [](Call& call) -> py::object {
                      const MatchedNames matched =
                          match_names(names_from(call["low"], "low"), names_from(call["high"], "high"));
                      py::dict result;
                      result["low"] = matched.low;
                      result["high"] = matched.high;
                      result["lone_low"] = strs_of(matched.lone_low);
                      result["lone_high"] = strs_of(matched.lone_high);
                      return result;
                  });
}

}  // namespace

void add_transfers(Module& module) {
    add_helpers(module);
    module.verb<LowDecoder, TransferOptions, GivenInputs, Running>(
        "transfer",
        {{"extent", "tuple[int, int]"}, {"low", "SelectedPart"}, {"high", "MeshPart | Mesh | Sequence[MeshPart]"}},
        "dict[str, Any]",
        "A dict of the fields of TransferredMaps, with None for maps that are not wanted; 'origin' is an array "
        "(height, "
        "width) of 0 (none), 1 (padding), 2 (missed) and 3 (hit). Lengths are numbers, texts such as '5%', or 'auto'. "
        "The fields of TransferInputs are keywords, too; each of `high_details` is a dict of the fields of HighDetail, "
        "or None.",
        [](Call& call, LowDecoder& keyword, TransferOptions& options, GivenInputs& given,
           Running& running) -> py::object {
            const Extent extent = Convert<Extent>::from(call["extent"], "extent");
            const TangentSpace low = space_of(selected_from(call["low"], "low"), keyword.decoder);
            const std::vector<MeshPart> high = parts_from(call["high"], "high");
            const OwnInputs own(given);
            return dict_of(
                running.run([&](const Execution& e) { return transfer(extent, low, high, own.inputs, options, e); }));
        });
}

}  // namespace tex::python
