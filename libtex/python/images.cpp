// SPDX-License-Identifier: Apache-2.0
// The class Image.

#include <fmt/format.h>
#include <pybind11/stl.h>

#include "errors.h"
#include "gil.h"
#include "modules.h"
#include "pickling.h"
#include "values.h"

namespace tex::python {
namespace {

// A picture owns its planes, so views of them keep the picture.
py::list planes_of(const py::object& self) {
    Image& image = self.cast<Image&>();
    py::list planes;
    for (Plane<float>& plane : image.planes) planes.append(view_of(plane.view(), self));
    return planes;
}

std::string listed_names(const Image& image) {
    std::string names;
    for (const std::string& name : image.names) names += (names.empty() ? "" : ", ") + shown_text(name);
    return names;
}

py::object channel_of(const py::object& self, const py::object& channel) {
    Image& image = self.cast<Image&>();
    if (!py::isinstance<py::str>(channel)) {
        throw py::type_error(
            fmt::format("channels have names: {}; image.planes lists their arrays, and "
                        "numpy.asarray(image) joins them",
                        std::string(str_of(listed_names(image)))));
    }
    const int plane = image.find(text_from(channel, "channel"));
    if (plane >= 0) return view_of(image.planes[static_cast<std::size_t>(plane)].view(), self);
    PyErr_SetObject(PyExc_KeyError,
                    str_of(fmt::format("no channel {}; there are {}. read_heights() and height_field() find heights",
                                       shown_text(text_from(channel, "channel")), listed_names(image)))
                        .ptr());
    throw py::error_already_set();
}

Image make_image(Call& call) {
    std::vector<std::string> names;
    if (call.has("names")) {
        const py::object given = call["names"];
        if (PySequence_Check(given.ptr()) == 0) raise_type("names", "a list of names", given);
        for (const py::handle name : given) names.push_back(text_from(name, "names"));
    }
    return image_from(call["array"], "array", names);
}

py::tuple shape_of(const Image& image) {
    const Extent extent = image.extent();
    if (image.planes.size() == 1) return py::make_tuple(extent.height, extent.width);
    return py::make_tuple(extent.height, extent.width, image.planes.size());
}

// (height, width) of one channel, else (height, width, channels), which is a copy.
py::array joined(const py::object& self, const py::object& dtype, const py::object& copy) {
    const py::list planes = planes_of(self);
    if (planes.size() == 1) return array_as(planes[0], dtype, copy);
    if (copy.ptr() == Py_False) throw py::value_error("the channels are joined in a copy");
    return array_as(py::module_::import("numpy").attr("stack")(planes, py::arg("axis") = -1), dtype, py::none());
}

// A PNG for a notebook; None if there is no picture of the channels.
py::object shown_image(const Image& image) {
    const auto png = without_gil([&] { return png_of(image); });
    if (!png) return py::none();
    return bytes_of(*png);
}

}  // namespace

Result<std::vector<std::byte>> png_of(const Image& image) {
    Image grey;
    for (const char* const name : {"R", "G", "B"}) {
        if (image.find("R") >= 0 && image.find("G") >= 0 && image.find("B") >= 0) break;
        grey.planes.push_back(image.planes.front().clone());
        grey.names.emplace_back(name);
    }
    const Result<Texture> picture = picture_of(grey.planes.empty() ? image : grey);
    if (!picture) return picture.error();
    return encode_picture(*picture);
}

void add_images(Module& module) {
    Class<Image>(module, "Image", "A picture as read from a file: planes of raw values, one for each channel.")
        .constructor({{"array", "ArrayLike"}, {"names", "Sequence[str] | None", "None"}}, 2, make_image)
        .property("planes", "list[NDArray[np.float32]]", "Arrays (height, width), in the order of the file.", planes_of)
        .property("names", "list[str]", "The channels: R, G, B, A, or Y for grey; those of EXR files keep their names.",
                  [](const Image& image) { return strs_of(image.names); })
        .property("extent", "tuple[int, int]", "(width, height) in texels.",
                  [](const Image& image) { return tuple_of(image.extent()); })
        .property("shape", "tuple[int, ...]", "(height, width, channels), or (height, width) of one channel.", shape_of)
        .property("sample", "str", "How the file stored values: 'unorm', 'snorm' or 'float'.",
                  [](const Image& image) { return word_of(image.sample); })
        .property("bits", "int", "Significant bits of a sample in the file.",
                  [](const Image& image) { return image.bits; })
        .property("normal_encoding", "str", "The EXR attribute normalEncoding, or empty.",
                  [](const Image& image) { return str_of(image.normal_encoding); })
        .property("normal_mark", "str", "What a picture that libtex wrote states about its channels, or empty.",
                  [](const Image& image) { return str_of(image.normal_mark); })
        .property("no_data", "float | None", "The value of texels without data, if the file names one.",
                  [](const Image& image) { return image.no_data; })
        .method("__getitem__", "(self, channel: str) -> NDArray[np.float32]", channel_of)
        .method("__array__", kArrayMethod, joined, py::arg("dtype") = py::none(), py::arg("copy") = py::none())
        .method("_repr_png_", "(self) -> bytes | None", shown_image)
        .method(
            "__repr__", "(self) -> str",
            [](const Image& image) {
                std::string names;
                for (const std::string& name : image.names) names += (names.empty() ? "" : " ") + name;
                return str_of(fmt::format("<tex.Image {}x{} {}>", image.extent().width, image.extent().height, names));
            })
        .copies()
        .finish();
}

}  // namespace tex::python
