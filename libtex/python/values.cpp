// SPDX-License-Identifier: Apache-2.0
#include "values.h"

#include <utility>

#include <fmt/format.h>
#include <pybind11/stl.h>

#include "modules.h"

namespace tex::python {
namespace {

// A picture owns its planes, so views of them keep the picture.
py::list planes_of(const py::object& self) {
    Image& image = self.cast<Image&>();
    py::list planes;
    for (Plane<float>& plane : image.planes) planes.append(view_of(plane.view(), self));
    return planes;
}

py::object channel_of(const py::object& self, const std::string& name) {
    Image& image = self.cast<Image&>();
    const int plane = image.find(name);
    if (plane < 0) throw py::key_error(name);
    return view_of(image.planes[static_cast<std::size_t>(plane)].view(), self);
}

void add_image(Module& module) {
    Class<Image>(module, "Image", "A picture as read from a file: planes of raw values, one for each channel.")
        .property("planes", "list[NDArray[np.float32]]", "Arrays (height, width), in the order of the file.", planes_of)
        .property("names", "list[str]", "The channels: R, G, B, A, or Y for grey; those of EXR files keep their names.",
                  [](const Image& image) { return image.names; })
        .property("extent", "tuple[int, int]", "(width, height) in texels.",
                  [](const Image& image) { return tuple_of(image.extent()); })
        .property("sample", "str", "How the file stored values: 'unorm', 'snorm' or 'float'.",
                  [](const Image& image) { return word_of(image.sample); })
        .property("bits", "int", "Significant bits of a sample in the file.",
                  [](const Image& image) { return image.bits; })
        .property("normal_encoding", "str", "The EXR attribute normalEncoding, or empty.",
                  [](const Image& image) { return image.normal_encoding; })
        .property("normal_mark", "str", "What a picture that libtex wrote states about its channels, or empty.",
                  [](const Image& image) { return image.normal_mark; })
        .property("no_data", "float | None", "The value of texels without data, if the file names one.",
                  [](const Image& image) { return image.no_data; })
        .method("__getitem__", "(self, channel: str) -> NDArray[np.float32]", channel_of)
        .method("__repr__", "(self) -> str",
                [](const Image& image) {
                    std::string names;
                    for (const std::string& name : image.names) names += (names.empty() ? "" : " ") + name;
                    return fmt::format("<tex.Image {}x{} {}>", image.extent().width, image.extent().height, names);
                })
        .finish();
}

template <class T>
py::object pair_of(T x, T y) {
    if constexpr (std::is_enum_v<T>) return py::make_tuple(word_of(x), word_of(y));
    return py::make_tuple(x, y);
}

void add_height_field(Module& module) {
    Class<HeightField>(module, "HeightField", "Heights, what lies beyond their border, and how steep they are.")
        .property("height", kArray, "The heights, (height, width); white is high.",
                  [](const py::object& self) { return view_of(self.cast<HeightField&>().height.view(), self); })
        .property("bumpiness", "tuple[float, float]", "The height of value 1.0 in texel widths, along x and y.",
                  [](const HeightField& field) { return py::make_tuple(field.bumpiness_x, field.bumpiness_y); })
        .property("wrap", "tuple[str, str]", "What lies beyond the border, along x and y.",
                  [](const HeightField& field) { return py::make_tuple(word_of(field.wrap_x), word_of(field.wrap_y)); })
        .method("__repr__", "(self) -> str",
                [](const HeightField& field) {
                    const Extent extent = field.height.extent();
                    return fmt::format("<tex.HeightField {}x{}>", extent.width, extent.height);
                })
        .finish();
}

// A level's bytes. The texture never changes and is kept by the array, which is kept by the memoryview.
py::object memory_of(const Level& level, const py::object& owner) {
    py::array bytes(py::dtype::of<std::uint8_t>(), {static_cast<py::ssize_t>(level.bytes.size())}, {py::ssize_t{1}},
                    level.bytes.data(), owner);
    bytes.attr("flags").attr("writeable") = false;
    return py::memoryview(bytes);
}

py::list levels_of(const py::object& self) {
    py::list levels;
    for (const Level& level : self.cast<const Texture&>().levels) levels.append(memory_of(level, self));
    return levels;
}

Texture make_texture(const std::string& format, const py::object& extent, const py::sequence& levels,
                     const py::object& swizzle, const py::object& y_axis) {
    Texture texture;
    texture.format = Convert<Format>::from(py::str(format), "format");
    const Extent base = Convert<Extent>::from(extent, "extent");
    need(base.width >= 1 && base.height >= 1, "extent", "sides must be 1 texel or more");
    need(levels.size() >= 1 && levels.size() <= static_cast<std::size_t>(level_count(base)), "levels",
         fmt::format("there must be 1 to {} levels", level_count(base)));
    for (std::size_t k = 0; k < levels.size(); ++k) {
        const Extent side = level_extent(base, static_cast<int>(k));
        const py::buffer_info bytes = py::buffer(levels[k]).request();
        const auto count = static_cast<std::size_t>(bytes.size * bytes.itemsize);
        const std::size_t wanted = level_bytes(texture.format, side);
        if (count != wanted || PyBuffer_IsContiguous(bytes.view(), 'C') == 0) {
            raise_value(fmt::format("levels[{}]", k),
                        fmt::format("expected {} contiguous bytes, got {}", wanted, count));
        }
        const auto* const data = static_cast<const std::byte*>(bytes.ptr);
        texture.levels.push_back({side, std::vector<std::byte>(data, data + count)});
    }
    texture.swizzle_known = !swizzle.is_none();
    if (texture.swizzle_known) texture.swizzle = Convert<Swizzle>::from(swizzle, "swizzle");
    texture.y_known = !y_axis.is_none();
    if (texture.y_known) texture.y_axis = Convert<YAxis>::from(y_axis, "y_axis");
    return texture;
}

void add_texture(Module& module) {
    Class<Texture> texture(module, "Texture", "A packed texture: the bytes of its levels and their meaning.");
    texture.constructor(
        "(self, format: str, extent: tuple[int, int], levels: Sequence[Buffer], *, swizzle: str | None = None, "
        "y_axis: str | None = None)",
        py::init(&make_texture), py::arg("format"), py::arg("extent"), py::arg("levels"), py::kw_only(),
        py::arg("swizzle") = py::none(), py::arg("y_axis") = py::none());
    texture
        .property("format", "str", "How texels are stored: 'bc3-unorm'.",
                  [](const Texture& self) { return word_of(self.format); })
        .property("encoding", "str | None", "The encoding of format and swizzle together: 'dxt5nm'.", encoding_of)
        .property("levels", "list[memoryview]", "The bytes of each level, read-only.", levels_of)
        .property("extent", "tuple[int, int]", "(width, height) of the base level, in texels.",
                  [](const Texture& self) { return tuple_of(self.extent()); })
        .property("swizzle", "str", "The layout of the channels: 'dxt5nm', or their letters.",
                  [](const Texture& self) { return layout_name(self.swizzle); })
        .property("swizzle_known", "bool", "The file states the swizzle.",
                  [](const Texture& self) { return self.swizzle_known; })
        .property("y_axis", "str", "The direction of y: 'up' or 'down'.",
                  [](const Texture& self) { return word_of(self.y_axis); })
        .property("y_known", "bool", "The file states the direction of y.",
                  [](const Texture& self) { return self.y_known; })
        .property("normal_encoding", "str", "'signed' if floats are the components themselves, or empty.",
                  [](const Texture& self) { return self.normal_encoding; })
        .property("srgb", "bool", "The file declares its colours as sRGB.",
                  [](const Texture& self) { return self.srgb; })
        .property("remarks", "list[str]", "Faults that the reader ignored, one sentence each.",
                  [](const Texture& self) { return self.remarks; })
        .method("__repr__", "(self) -> str",
                [](const Texture& self) {
                    return fmt::format("<tex.Texture {}x{} {}, {} {}>", self.extent().width, self.extent().height,
                                       name_of(kFormatNames, self.format), self.levels.size(),
                                       self.levels.size() == 1 ? "level" : "levels");
                })
        .finish();
}

template <class T>
py::object make_object(T value) {
    return py::cast(std::make_shared<T>(std::move(value)));
}

}  // namespace

HeightField field_from(py::handle from, std::string_view name, const Relief& relief, bool finite) {
    HeightField field;
    if (py::isinstance<HeightField>(from)) {
        const auto& given = from.cast<const HeightField&>();
        // The caller's object keeps the plane, as an array does.
        auto* const rows = const_cast<float*>(given.height.row(0));
        field.height = Plane<float>(given.height.extent(), given.height.stride(),
                                    std::shared_ptr<float>(std::shared_ptr<void>(), rows));
        field.bumpiness_x = given.bumpiness_x;
        field.bumpiness_y = given.bumpiness_y;
        field.wrap_x = given.wrap_x;
        field.wrap_y = given.wrap_y;
    } else {
        field.height = plane_from(from, name, finite);
    }
    field.bumpiness_x = relief.bumpiness_x.value_or(field.bumpiness_x);
    field.bumpiness_y = relief.bumpiness_y.value_or(field.bumpiness_y);
    field.wrap_x = relief.wrap_x.value_or(field.wrap_x);
    field.wrap_y = relief.wrap_y.value_or(field.wrap_y);
    need(std::isfinite(field.bumpiness_x) && std::isfinite(field.bumpiness_y), "bumpiness", "must be finite");
    return field;
}

Picture::Picture(py::handle from, std::string_view name)
    : image_(py::isinstance<Image>(from) ? from.cast<std::shared_ptr<Image>>()
                                         : std::make_shared<Image>(image_from(from, name))) {}

const Texture& texture_from(py::handle from, std::string_view name) {
    if (!py::isinstance<Texture>(from)) raise_type(name, "tex.Texture", from);
    return from.cast<const Texture&>();
}

py::object object_of(Image image) { return make_object(std::move(image)); }
py::object object_of(HeightField field) { return make_object(std::move(field)); }
py::object object_of(Texture texture) { return make_object(std::move(texture)); }

py::object encoding_of(const Texture& texture) {
    for (const Named<Encoding>& row : kEncodingNames) {
        const EncodingInfo info = encoding_info(row.value);
        if (info.format == texture.format && info.swizzle == texture.swizzle) return word_of(row.value);
    }
    return py::none();
}

void need_picture(const Texture& texture, std::string_view name) {
    need(texture.format == Format::rgb8_unorm && texture.levels.size() == 1, name,
         "must be a picture of the format 'rgb8-unorm' with one level, as preview() makes it");
}

py::bytes bytes_of(const std::vector<std::byte>& bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

void add_values(Module& module) {
    add_image(module);
    add_height_field(module);
    add_texture(module);
}

py::dict dict_of(const AngularError& error) {
    py::dict result;
    result["texels"] = error.texels;
    result["mean"] = error.mean;
    result["rms"] = error.rms;
    result["p50"] = error.p50;
    result["p99"] = error.p99;
    result["p999"] = error.p999;
    result["max"] = error.max;
    result["max_column"] = error.max_column;
    result["max_row"] = error.max_row;
    return result;
}

}  // namespace tex::python
