// SPDX-License-Identifier: Apache-2.0
// Normal maps to normal maps: levels, scale, blend; comparison and roughness.

#include <cmath>

#include <fmt/format.h>

#include "modules.h"
#include "running.h"
#include "values.h"

namespace tex::python {
namespace {

constexpr const char* kMap = "NDArray[np.float32]";
constexpr const char* kChain = "list[NDArray[np.float32]]";

// A map, or a number for all of it.
Plane<float> roughness_from(py::handle given) {
    if (!py::isinstance<py::float_>(given) && !py::isinstance<py::int_>(given)) return plane_from(given, "roughness");
    const float value = Convert<float>::from(given, "roughness");
    need(std::isfinite(value), "roughness", "must be finite");
    return Plane<float>({1, 1}, value);  // is stretched over the map
}

// A dict of a layer: `detail`, the fields of Layer, and perhaps a `mask`.
Layer layer_from(py::handle given, const std::string& name) {
    if (!py::isinstance<py::dict>(given)) raise_type(name, "a dict with 'detail' and the fields of Layer", given);
    const py::dict fields = py::reinterpret_steal<py::dict>(PyDict_Copy(given.ptr()));
    need(fields.contains("detail"), name, "needs 'detail', a normal map or its levels");
    Layer layer;
    layer.detail = chain_from(fields.attr("pop")("detail"), name + "['detail']");
    const py::object mask = fields.attr("pop")("mask", py::none());
    if (!mask.is_none()) layer.mask = plane_from(mask, name + "['mask']");
    Reader reader(fields);
    each_placement(layer, reader);
    reader.finish(name);
    return layer;
}

py::object blended(Call& call, BlendOptions& options, Running& running) {
    need((options.extent.width == 0) == (options.extent.height == 0), "extent", "both sides or neither must be 0");
    MipChain base = chain_from(call["base"], "base");
    std::vector<Layer> layers;
    const py::object given = call["layers"];
    if (!py::isinstance<py::list>(given) && !py::isinstance<py::tuple>(given))
        raise_type("layers", "a list of dicts", given);
    for (const py::handle layer : given) layers.push_back(layer_from(layer, fmt::format("layers[{}]", layers.size())));
    return array_of(
        running.run([&](const Execution& e) { return blend(std::move(base), std::move(layers), options, e); }));
}

py::object compared(Call& call, Running& running) {
    const NormalMap a = map_from(call["a"], "a"), b = map_from(call["b"], "b");
    need_equal(b.extent(), a.extent(), "b");
    const bool on_mesh = call.has("part") && !call["part"].is_none();
    const MeshPart* part = nullptr;
    if (on_mesh) {
        if (!py::isinstance<MeshPart>(call["part"])) raise_type("part", "a MeshPart", call["part"]);
        part = &call["part"].cast<const MeshPart&>();
    }
    const int set = call.has("uv_set") ? Convert<int>::from(call["uv_set"], "uv_set") : 0;
    Comparison comparison = running.run(
        [&](const Execution& e) { return part != nullptr ? compare(a, b, *part, set, e) : compare(a, b, e); });
    py::dict result = dict_of(comparison.error);
    result["degrees"] = array_of(std::move(comparison.degrees));
    return result;
}

struct RoughnessKeywords : MipOptions {};

template <class F>
void each_field(RoughnessKeywords& o, F& f) {
    level_fields(o, f);
}

void add_roughness(Module& module) {
    module.verb<RoughnessKeywords, Running>(
        "build_roughness_chain",
        {{"base", kMapSource}, {"roughness", "ArrayLike | float"}, {"model", "str", "'toksvig'"}}, kChain,
        "The roughness of every level, arrays (height, width). `roughness` is a map or one number.",
        [](Call& call, RoughnessKeywords& options, Running& running) -> py::object {
            const NormalMap base = map_from(call["base"], "base");
            const Plane<float> roughness = roughness_from(call["roughness"]);
            const auto model =
                call.has("model") ? Convert<RoughnessModel>::from(call["model"], "model") : RoughnessModel::toksvig;
            RoughnessChain chain = running.run(
                [&](const Execution& e) { return build_roughness_chain(base, roughness, model, options, e); });
            py::list levels;
            for (Plane<float>& level : chain.levels) levels.append(array_of(std::move(level)));
            return levels;
        });
    module.verb<Running>(
        "pack_roughness",
        {{"chain", "Sequence[ArrayLike]"}, {"format", "str", "'r8-unorm'"}, {"effort", "str", "'normal'"}}, "Texture",
        "`chain` is a list of arrays (height, width), as build_roughness_chain() returns it.",
        [](Call& call, Running& running) -> py::object {
            RoughnessChain chain;
            const auto levels = call["chain"];
            if (!py::isinstance<py::list>(levels) && !py::isinstance<py::tuple>(levels))
                raise_type("chain", "a list of arrays", levels);
            for (const py::handle level : levels) {
                const auto k = static_cast<int>(chain.levels.size());
                const std::string name = fmt::format("chain[{}]", k);
                // A copy, because codecs read whole blocks.
                chain.levels.push_back(plane_from(level, name).clone());
                need_equal(chain.levels.back().extent(), level_extent(chain.levels.front().extent(), k), name);
            }
            need(!chain.levels.empty(), "chain", "there is no level");
            const auto format = call.has("format") ? Convert<Format>::from(call["format"], "format") : Format::r8_unorm;
            const auto effort = call.has("effort") ? Convert<Effort>::from(call["effort"], "effort") : Effort::normal;
            return object_of(running.run([&](const Execution& e) { return pack_roughness(chain, format, effort, e); }));
        });
}

}  // namespace

void add_normals(Module& module) {
    module.verb<MipOptions, Running>(
        "build_mip_chain", {{"base", kMapSource}}, kChain,
        "A list of arrays, one for each level. The first one shows the memory of `base` if that came from libtex.",
        [](Call& call, MipOptions& options, Running& running) -> py::object {
            NormalMap base = map_from(call["base"], "base");
            return arrays_of(
                running.run([&](const Execution& e) { return build_mip_chain(std::move(base), options, e); }));
        });
    module.overload({{"list[NDArray[np.float32]] | tuple[NDArray[np.float32], ...]", kChain}, {kMapSource, kMap}});
    module.verb<Running>(
        "scale", {{"n", kChainSource}, {"scale", "float"}, {"mode", "str", "'slope'"}}, "Any",
        "Of an array (height, width, 3), or of every level of a list of them; returns the same. The argument is not "
        "changed.",
        [](Call& call, Running& running) -> py::object {
            const float by = Convert<float>::from(call["scale"], "scale");
            const auto mode = call.has("mode") ? Convert<ScaleMode>::from(call["mode"], "mode") : ScaleMode::slope;
            MipChain chain = chain_from(call["n"], "n", Sharing::writes);
            chain = running.run([&](const Execution& e) { return scale(std::move(chain), by, mode, e); });
            const bool one = !py::isinstance<py::list>(call["n"]) && !py::isinstance<py::tuple>(call["n"]);
            if (one) return array_of(std::move(chain.levels.front()));
            return arrays_of(std::move(chain));
        });
    module.verb<BlendOptions, Running>(
        "blend", {{"base", kChainSource}, {"layers", "Sequence[dict[str, Any]]"}}, kMap,
        "`layers` is a list of dicts: 'detail' is a normal map or a list of its levels; the other keys are the fields "
        "of "
        "Layer: 'scale', 'tiling', 'offset', 'rotation', 'wrap', 'strength' and 'mask', an array (height, width).",
        blended);
    module.verb<Running>(
        "compare", {{"a", kMapSource}, {"b", kMapSource}, {"part", "MeshPart | None", "None"}, {"uv_set", "int", "0"}},
        "dict[str, Any]",
        "A dict of the fields of AngularError, and 'degrees': the angle of each texel, an array (height, "
        "width). With a part of a mesh, of the texels that it covers.",
        compared);
    add_roughness(module);
}

}  // namespace tex::python
