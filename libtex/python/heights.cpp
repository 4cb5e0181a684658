// SPDX-License-Identifier: Apache-2.0
// Heights: pictures to height fields, height fields to normals.

#include <pybind11/stl.h>

#include "modules.h"
#include "running.h"
#include "values.h"

namespace tex::python {
namespace {

// Most pictures are sRGB.
struct FromColor : ColorOptions {
    FromColor() { space = "sRGB"; }
};

void add_strengths(Module& module) {
    module.verb("strength_from_world",
                {{"extent", "tuple[int, int]"}, {"range", "float"}, {"width", "float"}, {"height", "float", "0.0"}},
                "tuple[float, float]", "The bumpiness (x, y) for bake(), from world units.",
                [](Call& call) -> py::object {
                    const auto number = [&](const char* name) {
                        const double value = call.has(name) ? number_from(call[name], name) : 0.0;
                        need(std::isfinite(value), name, "must be finite");
                        return value;
                    };
                    const Extent extent = Convert<Extent>::from(call["extent"], "extent");
                    const double width = number("width"), height = number("height");
                    need(width > 0.0, "width", "must be above 0");
                    need(height >= 0.0, "height", "must be 0 or more");
                    const Strength strength = value_of(strength_from_world(extent, number("range"), width, height));
                    return py::make_tuple(strength.x, strength.y);
                });
    module.verb("strength_from_uv", {{"extent", "tuple[int, int]"}, {"r", "float"}}, "tuple[float, float]",
                "The bumpiness (x, y) for bake(), from texture widths.", [](Call& call) -> py::object {
                    const double r = number_from(call["r"], "r");
                    need(std::isfinite(r), "r", "must be finite");
                    const Strength strength =
                        value_of(strength_from_uv(Convert<Extent>::from(call["extent"], "extent"), r));
                    return py::make_tuple(strength.x, strength.y);
                });
}

py::dict dict_of_deband(const DebandReport& report) {
    py::dict facts;
    facts["applied"] = report.applied;
    facts["step"] = report.step;
    facts["codes"] = report.codes;
    facts["terrace_texels"] = report.terrace_texels;
    return facts;
}

void tell(const py::dict& facts, const HeightReport& report) {
    facts["luma_texels"] = report.luma_texels;
    facts["invalid_texels"] = report.invalid_texels;
    facts["implausible_texels"] = report.implausible_texels;
    facts["stored"] = report.stored;
    facts["remark"] = str_of(report.remark);
    facts["ground"] = object_of(report.ground);
    facts["ground_remark"] = str_of(report.ground_remark);
    facts["deband"] = dict_of_deband(report.deband);
}

// The caller's array stays as it is.
py::object debanded(Call& call, Relief& relief, Running& running) {
    const Deband when = call.has("when") ? Convert<Deband>::from(call["when"], "when") : Deband::on;
    HeightField given = field_from(call["height"], "height", relief);
    HeightField field{given.height.clone(), given.bumpiness_x, given.bumpiness_y,
                      given.wrap_x,         given.wrap_y,      given.ground};
    DebandedField found = running.run([&](const Execution& e) { return deband(std::move(field), when, e); });
    py::dict result = dict_of_deband(found.report);
    result["field"] = object_of(static_cast<HeightField&&>(found));
    return result;
}

// The maps that are wanted, by the names of OcclusionMaps.
py::object hidden(Call& call, Relief& relief, OcclusionOptions& options, BakeOptions& how, Running& running) {
    const HeightField field = field_from(call["height"], "height", relief, false);  // occlusion() checks
    OcclusionMaps maps = running.run([&](const Execution& e) { return occlusion(field, options, how, e); });
    py::dict result;
    if (options.occlusion) result["occlusion"] = array_of(std::move(maps.occlusion));
    if (options.sky_view) result["sky_view"] = array_of(std::move(maps.sky_view));
    if (options.bent) result["bent"] = array_of(std::move(maps.bent));
    if (options.horizons > 0) {
        py::list planes;
        for (Plane<float>& plane : maps.horizons) planes.append(array_of(std::move(plane)));
        result["horizons"] = py::module_::import("numpy").attr("stack")(planes);
    }
    return result;
}

}  // namespace

void add_heights(Module& module) {
    module.verb<HeightOptions, Running>(
        "height_field", {{"image", kPicture}, {"report", "dict[str, Any] | None", "None"}}, "HeightField",
        "The heights of a picture, or of an array (height, width) or (height, width, channels), of which "
        "`channel` chooses one. `report` is a dict that gets the fields of HeightReport.",
        [](Call& call, HeightOptions& options, Running& running) -> py::object {
            const Picture image(call["image"], "image");
            if (call.has("report") && !py::isinstance<py::dict>(call["report"]))
                raise_type("report", "a dict", call["report"]);
            PictureHeights field = running.run([&](const Execution& e) { return height_field(*image, options, e); });
            field.wrap_x = options.wrap_x;
            field.wrap_y = options.wrap_y;
            if (call.has("report")) tell(call["report"], field.report);
            return object_of(std::move(field));
        });
    module.verb<Relief, Running>("deband", {{"height", kHeights}, {"when", "str", "'on'"}}, "dict[str, Any]",
                                 "A dict of the fields of DebandReport, and 'field': a new HeightField with the "
                                 "debanded heights. `height` is an "
                                 "array (height, width) or a HeightField; bumpiness and wrap as in bake().",
                                 debanded);
    module.verb<Relief, BakeOptions, Running>(
        "bake", {{"height", kHeights}}, "NDArray[np.float32]",
        "The normals of heights, an array (height, width, 3) of x, y and z. `height` is an array (height, width), a "
        "HeightField, or a path or an Image, of which height_field() chooses the channel. bumpiness (for an array 1, "
        "for an elevation model that states the size of its texels the slopes of the ground) and wrap ('repeat' for "
        "an array) are a value or a pair for x and y.",
        [](Call& call, Relief& relief, BakeOptions& options, Running& running) -> py::object {
            const HeightField field = field_from(call["height"], "height", relief, false);  // bake() checks
            return array_of(running.run([&](const Execution& e) { return bake(field, options, e); }));
        });
    module.verb<Relief, OcclusionOptions, BakeOptions, Running>(
        "occlusion", {{"height", kHeights}}, "dict[str, NDArray[np.float32]]",
        "A dict of the maps that are wanted: 'occlusion' and 'sky_view' are arrays (height, width), 'bent' is one of "
        "(height, width, 3), and 'horizons' one of (horizons, height, width). `height`, bumpiness and wrap are those "
        "of bake(); texels that are NaN are holes.",
        hidden);
    module.verb<Running>("slope_range", {{"n", kMapSource}}, "dict[str, tuple[float, float]]",
                         "The range of slopes in a normal map, {'x': (least, greatest), 'y': (least, greatest)}: rise "
                         "per texel width to "
                         "the right (x) and upwards (y).",
                         [](Call& call, Running& running) -> py::object {
                             const NormalMap map = map_from(call["n"], "n");
                             const SlopeRange range = running.run(
                                 [&](const Execution& e) -> Result<SlopeRange> { return slope_range(map, e); });
                             py::dict slopes;
                             slopes["x"] = py::make_tuple(range.min_x, range.max_x);
                             slopes["y"] = py::make_tuple(range.min_y, range.max_y);
                             return slopes;
                         });
    module.verb<FromColor>(
        "to_linear", {{"image", kPicture}}, "Image",
        "A new picture with linear values. Without `config`, `space` is 'sRGB' or 'linear'.",
        [](Call& call, FromColor& options) -> py::object {
            const Picture given(call["image"], "image");
            Image image;
            image.names = (*given).names;
            image.sample = (*given).sample;
            image.bits = (*given).bits;
            image.normal_encoding = (*given).normal_encoding;
            image.normal_mark = (*given).normal_mark;
            image.no_data = (*given).no_data;
            for (const Plane<float>& plane : (*given).planes) image.planes.push_back(plane.clone());
            return object_of(value_of(without_gil([&] { return to_linear(std::move(image), options); })));
        });
    module.verb<ColorOptions>("color_files", {}, "list[str]", "The files on which to_linear() depends.",
                              [](Call&, ColorOptions& options) -> py::object {
                                  return strs_of(value_of(without_gil([&] { return color_files(options); })));
                              });
    add_strengths(module);
}

}  // namespace tex::python
