// SPDX-License-Identifier: Apache-2.0
// Normals to heights, and how surfaces bend.

#include <cmath>

#include "modules.h"
#include "running.h"
#include "values.h"

namespace tex::python {
namespace {

constexpr const char* kInvalid =
    " An array may have texels that are NaN, as unpack(..., keep_invalid=True) returns them; those of a path, an Image "
    "or a Texture are flat, as unpack() makes them.";

py::object integrated(Call& call, IntegrateOptions& options, Running& running) {
    const NormalMap map = map_from(call["n"], "n", Sharing::reads, Normals::any);
    Integration found = running.run([&](const Execution& e) { return integrate(map, options, e); });
    py::dict result;
    result["height"] = array_of(std::move(found.field.height));
    result["highest"] = found.highest;
    result["curl"] = dict_of(found.curl);
    result["degrees"] = array_of(std::move(found.degrees));
    result["unused_texels"] = found.unused_texels;
    result["steps"] = found.steps;
    return result;
}

py::object bent(Call& call, CurvatureOptions& options, Running& running) {
    const NormalMap map = map_from(call["n"], "n", Sharing::reads, Normals::any);
    Curvature found = running.run([&](const Execution& e) { return curvature(map, options, e); });
    py::dict result;
    result["values"] = array_of(std::move(found.values));
    result["least"] = found.least;
    result["greatest"] = found.greatest;
    result["rms"] = found.rms;
    return result;
}

}  // namespace

void add_surfaces(Module& module) {
    module.verb<IntegrateOptions, Running>(
        "integrate", {{"n", kMapSource}}, "dict[str, Any]",
        std::string("A dict of the fields of Integration: 'height' and 'degrees' are arrays (height, width), and "
                    "'curl' has the "
                    "fields of AngularError. bake(result['height'], bumpiness=..., wrap=...) gives the map back.") +
            kInvalid,
        integrated);
    module.verb<CurvatureOptions, Running>(
        "curvature", {{"n", kMapSource}}, "dict[str, Any]",
        std::string("A dict of the fields of Curvature: 'values' is an array (height, width).") + kInvalid, bent);
}

}  // namespace tex::python
