// SPDX-License-Identifier: Apache-2.0
#include "values.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <pybind11/stl.h>

#include "errors.h"
#include "finite.h"
#include "gil.h"
#include "modules.h"
#include "pickling.h"
#include "sources.h"

namespace tex::python {
namespace {

template <class T>
py::object pair_of(T x, T y) {
    if constexpr (std::is_enum_v<T>) return py::make_tuple(word_of(x), word_of(y));
    return py::make_tuple(x, y);
}

HeightField make_field(Call& call) {
    Relief relief;
    Reader fields(py::dict(py::arg("bumpiness") = call.has("bumpiness") ? call["bumpiness"] : py::float_(1.0),
                           py::arg("wrap") = call.has("wrap") ? call["wrap"] : py::str("repeat")));
    each_field(relief, fields);
    HeightField field = field_from(call["height"], "height", relief);
    field.height = field.height.clone();
    return field;
}

void add_height_field(Module& module) {
    Class<HeightField>(module, "HeightField", "Heights, what lies beyond their border, and how steep they are.")
        .constructor({{"height", kHeights},
                      {"bumpiness", "float | tuple[float, float]", "1.0"},
                      {"wrap", "str | tuple[str, str]", "'repeat'"}},
                     3, make_field)
        .property("height", kArray, "The heights, (height, width); white is high.",
                  [](const py::object& self) { return view_of(self.cast<HeightField&>().height.view(), self); })
        .property("shape", "tuple[int, int]", "(height, width), as of an array.",
                  [](const HeightField& field) {
                      return py::make_tuple(field.height.extent().height, field.height.extent().width);
                  })
        .property("bumpiness", "tuple[float, float]", "The height of value 1.0 in texel widths, along x and y.",
                  [](const HeightField& field) { return py::make_tuple(field.bumpiness_x, field.bumpiness_y); })
        .property("ground", "dict[str, Any] | None",
                  "The fields of Ground, if the heights lie on the ground; bumpiness is then a factor on its slopes.",
                  [](const HeightField& field) { return object_of(field.ground); })
        .property("wrap", "tuple[str, str]", "What lies beyond the border, along x and y.",
                  [](const HeightField& field) { return py::make_tuple(word_of(field.wrap_x), word_of(field.wrap_y)); })
        .method(
            "__array__", kArrayMethod,
            [](const py::object& self, const py::object& dtype, const py::object& copy) {
                return array_as(self.attr("height"), dtype, copy);
            },
            py::arg("dtype") = py::none(), py::arg("copy") = py::none())
        .method("__repr__", "(self) -> str",
                [](const HeightField& field) {
                    const Extent extent = field.height.extent();
                    return fmt::format("<tex.HeightField {}x{}>", extent.width, extent.height);
                })
        .copies()
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

Texture make_texture(Call& call) {
    Texture texture;
    texture.format = Convert<Format>::from(call["format"], "format");
    const Extent base = Convert<Extent>::from(call["extent"], "extent");
    need(base.width >= 1 && base.height >= 1, "extent", "sides must be 1 texel or more");
    const py::object levels = call["levels"];
    if (PySequence_Check(levels.ptr()) == 0 || PyObject_CheckBuffer(levels.ptr()) != 0)
        raise_type("levels", "a list of the bytes of each level", levels);
    const std::size_t count = py::len(levels);
    need(count >= 1 && count <= static_cast<std::size_t>(level_count(base)), "levels",
         fmt::format("there must be 1 to {} levels", level_count(base)));
    for (std::size_t k = 0; k < count; ++k) {
        const std::string name = fmt::format("levels[{}]", k);
        const Extent side = level_extent(base, static_cast<int>(k));
        std::vector<std::byte> bytes = bytes_from(levels[py::int_(k)], name);
        const std::size_t wanted = level_bytes(texture.format, side);
        need(bytes.size() == wanted, name, fmt::format("expected {} bytes, got {}", wanted, bytes.size()));
        texture.levels.push_back({side, std::move(bytes)});
    }
    texture.swizzle_known = call.has("swizzle");
    if (texture.swizzle_known) texture.swizzle = Convert<Swizzle>::from(call["swizzle"], "swizzle");
    texture.y_known = call.has("y_axis");
    if (texture.y_known) texture.y_axis = Convert<YAxis>::from(call["y_axis"], "y_axis");
    return texture;
}

// The largest level that a page shows at once, as a PNG; None if there is no picture of it.
py::object shown_texture(const Texture& texture) {
    constexpr int kLargestSide = 1024;
    const auto is_small = [](const Level& level) {
        return std::max(level.extent.width, level.extent.height) <= kLargestSide;
    };
    const auto level = std::find_if(texture.levels.begin(), texture.levels.end(), is_small);
    const auto k = static_cast<int>(level == texture.levels.end() ? 0 : level - texture.levels.begin());
    const auto png = without_gil([&]() -> Result<std::vector<std::byte>> {
        if (texture.format == Format::rgb8_unorm && texture.levels.size() == 1) return encode_picture(texture);
        if (format_info(texture.format).channels > 1) {
            Texture shown;
            shown.format = texture.format;
            shown.swizzle = texture.swizzle;
            shown.normal_encoding = texture.normal_encoding;
            shown.levels.push_back(texture.levels[static_cast<std::size_t>(k)]);
            if (const Result<MipChain> normals = unpack(shown)) {
                PackOptions options;
                options.encoding = Encoding::rgb8;
                const Result<PackedTexture> colours = pack(*normals, options);
                if (colours) return encode_picture(*colours);
            }
        }
        const Result<Image> channels = decode(texture, k);
        if (!channels) return channels.error();
        return png_of(*channels);
    });
    if (!png) return py::none();
    return bytes_of(*png);
}

void add_texture(Module& module) {
    Class<Texture> texture(module, "Texture", "A packed texture: the bytes of its levels and their meaning.");
    texture.constructor({{"format", "str"},
                         {"extent", "tuple[int, int]"},
                         {"levels", "Sequence[Buffer]"},
                         {"swizzle", "str | None", "None"},
                         {"y_axis", "str | None", "None"}},
                        3, make_texture);
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
                  [](const Texture& self) { return str_of(self.normal_encoding); })
        .property("srgb", "bool", "The file declares its colours as sRGB.",
                  [](const Texture& self) { return self.srgb; })
        .property("orientation", "int",
                  "The orientation that the file states, 1 to 8. The texels were turned accordingly, but for PNG.",
                  [](const Texture& self) { return self.orientation; })
        .property("trailing_bytes", "int", "Bytes beyond the levels, which were not read.",
                  [](const Texture& self) { return self.trailing_bytes; })
        .property("remarks", "list[str]", "Other faults that the reader ignored, one sentence each.",
                  [](const Texture& self) { return strs_of(self.remarks); })
        .method("__repr__", "(self) -> str",
                [](const Texture& self) {
                    return fmt::format("<tex.Texture {}x{} {}, {} {}>", self.extent().width, self.extent().height,
                                       name_of(kFormatNames, self.format), self.levels.size(),
                                       self.levels.size() == 1 ? "level" : "levels");
                })
        .method("_repr_png_", "(self) -> bytes | None", shown_texture)
        .copies()
        .finish();
}

template <class T>
py::object make_object(T value) {
    return py::cast(std::make_shared<T>(std::move(value)));
}

constexpr const char* kUnsound = "some values are infinite or NaN";

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
        field.ground = given.ground;
        need(!finite || without_gil([&] { return is_finite(field.height.view()); }), name, kUnsound);
    } else if (std::optional<HeightField> read = field_of_source(from)) {
        field = std::move(*read);
    } else {
        field.height = plane_from(from, name, finite);
    }
    if (relief.bumpiness_x || relief.bumpiness_y) field.ground.reset();
    field.bumpiness_x = relief.bumpiness_x.value_or(field.bumpiness_x);
    field.bumpiness_y = relief.bumpiness_y.value_or(field.bumpiness_y);
    field.wrap_x = relief.wrap_x.value_or(field.wrap_x);
    field.wrap_y = relief.wrap_y.value_or(field.wrap_y);
    need(std::isfinite(field.bumpiness_x) && std::isfinite(field.bumpiness_y), "bumpiness", "must be finite");
    return field;
}

Picture::Picture(py::handle from, std::string_view name) {
    if (py::isinstance<Image>(from)) {
        image_ = from.cast<std::shared_ptr<Image>>();
    } else if (is_path(from)) {
        const std::string path = path_from(from, name);
        image_ = std::make_shared<Image>(value_of(without_gil([&] { return read_image(path); })));
    } else {
        image_ = std::make_shared<Image>(image_from(from, name));
    }
}

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

// The bytes of any contiguous buffer.
std::vector<std::byte> bytes_from(py::handle given, std::string_view name) {
    if (PyObject_CheckBuffer(given.ptr()) == 0) raise_type(name, "bytes or another buffer", given);
    const py::buffer_info info = py::reinterpret_borrow<py::buffer>(given).request();
    need(PyBuffer_IsContiguous(info.view(), 'C') != 0, name, "must be contiguous");
    const auto* const data = static_cast<const std::byte*>(info.ptr);
    return {data, data + info.size * info.itemsize};
}

py::bytes bytes_of(const std::vector<std::byte>& bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

void add_values(Module& module) {
    add_height_field(module);
    add_texture(module);
}

py::object object_of(const std::optional<Ground>& ground) {
    if (!ground) return py::none();
    py::dict result;
    result["unit"] = word_of(ground->unit);
    result["width"] = ground->width;
    result["height"] = ground->height;
    result["north"] = ground->north;
    result["north_up"] = ground->north_up;
    result["equator_radius"] = ground->equator_radius;
    result["pole_radius"] = ground->pole_radius;
    result["height_metres"] = ground->height_metres;
    result["has_height_unit"] = ground->has_height_unit;
    return result;
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
