// SPDX-License-Identifier: Apache-2.0
// Pictures of normal maps, and sheets of pictures.

#include <cmath>

#include <fmt/format.h>
#include <pybind11/stl.h>

#include "meshes.h"
#include "modules.h"
#include "running.h"
#include "values.h"

namespace tex::python {
namespace {

// What a PreviewScene has besides the normal map.
struct Scene {
    py::object detail = py::none(), albedo = py::none(), detail_albedo = py::none(), height_map = py::none();
    float white = 1.0f;
    bool map_without_z = false, detail_without_z = false;
    py::object mesh = py::none();
    Decoder decoder = Decoder::gltf;
};

template <class F>
void each_field(Scene& o, F& f) {
    f("detail_map", o.detail, "ArrayLike | Sequence[ArrayLike] | None");
    f("albedo", o.albedo, "ArrayLike | Image | str | PathLike[str] | None");
    f("detail_albedo", o.detail_albedo, "ArrayLike | Image | str | PathLike[str] | None");
    f("height_map", o.height_map, "ArrayLike | None");
    f("white", o.white);
    f("map_without_z", o.map_without_z);
    f("detail_without_z", o.detail_without_z);
    f("mesh", o.mesh, "SelectedPart | None");
    f("decoder", o.decoder);
}

py::object previewed(Call& call, Scene& given, PreviewOptions& options, Running& running) {
    const MipChain map = chain_from(call["n"], "n");
    MipChain detail;
    Plane<float> height;
    std::optional<Picture> albedo, detail_albedo;
    PreviewScene scene;
    scene.map = &map;
    scene.white = given.white;
    scene.map_without_z = given.map_without_z;
    scene.detail_without_z = given.detail_without_z;
    if (!given.detail.is_none()) {
        detail = chain_from(given.detail, "detail_map");
        scene.detail = &detail;
    }
    if (!given.albedo.is_none()) scene.albedo = &*albedo.emplace(given.albedo, "albedo");
    if (!given.detail_albedo.is_none())
        scene.detail_albedo = &*detail_albedo.emplace(given.detail_albedo, "detail_albedo");
    if (!given.height_map.is_none()) {
        height = plane_from(given.height_map, "height_map").clone();
        scene.height = &height;
    }
    std::optional<TangentSpace> space;
    if (!given.mesh.is_none()) scene.mesh = &space.emplace(space_of(selected_from(given.mesh, "mesh"), given.decoder));
    return object_of(running.run([&](const Execution& e) { return preview(scene, options, e); }));
}

// A list of pairs (picture, caption).
std::vector<Panel> panels_from(py::handle given, const char* name) {
    if (!py::isinstance<py::list>(given) && !py::isinstance<py::tuple>(given))
        raise_type(name, "a list of pairs", given);
    std::vector<Panel> panels;
    for (const py::handle item : given) {
        const std::vector<py::object> pair = items_from(item, name, 2, "pairs (picture, caption)");
        panels.push_back({texture_from(pair[0], name), text_from(pair[1], name)});
        need_picture(panels.back().picture, name);
    }
    return panels;
}

void add_sheets(Module& module) {
    module.verb<>("picture_of", {{"image", kPicture}}, "Texture", "", [](Call& call) -> py::object {
        const Picture image(call["image"], "image");
        return object_of(value_of(without_gil([&] { return picture_of(*image); })));
    });
    module.verb<>("encode_picture", {{"picture", "Texture"}}, "bytes", "", [](Call& call) -> py::object {
        const Texture& picture = texture_from(call["picture"], "picture");
        need_picture(picture, "picture");
        return bytes_of(value_of(without_gil([&] { return encode_picture(picture); })));
    });
    module.verb<>("contact_sheet", {{"panels", "Sequence[tuple[Texture, str]]"}, {"columns", "int", "0"}}, "Texture",
                  "`panels` is a list of pairs (picture, caption).", [](Call& call) -> py::object {
                      const std::vector<Panel> panels = panels_from(call["panels"], "panels");
                      const int columns = call.has("columns") ? Convert<int>::from(call["columns"], "columns") : 0;
                      need(columns >= 0, "columns", "must be 0 or more");
                      return object_of(value_of(without_gil([&] { return contact_sheet(panels, columns); })));
                  });
    module.verb<>("split_view", {{"left", "tuple[Texture, str]"}, {"right", "tuple[Texture, str]"}}, "Texture",
                  "Both are pairs (picture, caption).", [](Call& call) -> py::object {
                      const std::vector<Panel> panels =
                          panels_from(py::make_tuple(call["left"], call["right"]), "left, right");
                      return object_of(value_of(without_gil([&] { return split_view(panels[0], panels[1]); })));
                  });
    module.verb<>("encode_animation", {{"pictures", "Sequence[Texture]"}, {"frames_per_second", "int", "20"}}, "bytes",
                  "", [](Call& call) -> py::object {
                      const py::object given = call["pictures"];
                      if (!py::isinstance<py::list>(given) && !py::isinstance<py::tuple>(given))
                          raise_type("pictures", "a list of pictures", given);
                      std::vector<Texture> pictures;
                      for (const py::handle picture : given) {
                          pictures.push_back(texture_from(picture, "pictures"));
                          need_picture(pictures.back(), "pictures");
                      }
                      const int rate = call.has("frames_per_second")
                                           ? Convert<int>::from(call["frames_per_second"], "frames_per_second")
                                           : 20;
                      need(rate >= 1 && rate <= 1000, "frames_per_second", "must be from 1 to 1000");
                      return bytes_of(value_of(without_gil([&] { return encode_animation(pictures, rate); })));
                  });
}

}  // namespace

void add_pictures(Module& module) {
    module.verb<Scene, PreviewOptions, Running>(
        "preview", {{"n", kChainSource}}, "Texture",
        "A picture (rgb8, one level) of a map, or of a list of its levels. Structures are dicts with the names of "
        "their fields: light={'x': 1.0}. `mesh` is what select_part() returns. encode_picture() makes a PNG of it, "
        "write_texture() a file.",
        previewed);
    module.verb<Running>(
        "heat_map", {{"degrees", "ArrayLike"}, {"full_scale", "float"}}, "Image",
        "`degrees` is an array (height, width), as compare() returns it.",
        [](Call& call, Running& running) -> py::object {
            const Plane<float> degrees = plane_from(call["degrees"], "degrees");
            const double full_scale = number_from(call["full_scale"], "full_scale");
            need(full_scale > 0.0 && full_scale <= 180.0, "full_scale", "must be above 0 and at most 180");
            return object_of(running.run([&](const Execution& e) { return heat_map(degrees, full_scale, e); }));
        });
    module.verb<>("largest_of_cells", {{"degrees", "ArrayLike"}, {"side", "int"}}, "NDArray[np.float32]", "",
                  [](Call& call) -> py::object {
                      const Plane<float> degrees = plane_from(call["degrees"], "degrees");
                      const int side = Convert<int>::from(call["side"], "side");
                      need(side >= 1, "side", "must be 1 or more");
                      return array_of(value_of(without_gil([&] { return largest_of_cells(degrees, side); })));
                  });
    add_sheets(module);
}

}  // namespace tex::python
