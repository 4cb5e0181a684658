// SPDX-License-Identifier: Apache-2.0
// Files: pictures, textures, and normals from either.

#include "modules.h"
#include "running.h"
#include "values.h"

namespace tex::python {
namespace {

// SourceOptions of somebody who may not look at `info`.
struct NormalsKeywords : SourceOptions {
    NormalsKeywords() { doubt_y = true; }
};

template <class F>
void each_field(NormalsKeywords& o, F& f) {
    each_field(static_cast<SourceOptions&>(o), f);
}

void warn_of_y(const std::string& path) {
    const std::string text = path +
                             ": y is taken to point up, but the texels show that it points down; "
                             "unpack={'y_axis': 'down'} reads it so";
    if (PyErr_WarnEx(PyExc_UserWarning, text.c_str(), 1) != 0) throw py::error_already_set();
}

constexpr const char* kPath = "str | PathLike[str]";

// The container that a word or the extension of a path names.
Container container_from(py::handle given) { return Convert<Container>::from(given, "container"); }

void add_reading(Module& module) {
    module.verb<ReadOptions>("read_image", {{"path", kPath}}, "Image", "A picture with all its channels, raw values.",
                             [](Call& call, ReadOptions& options) -> py::object {
                                 const std::string path = path_from(call["path"], "path");
                                 return object_of(value_of(without_gil([&] { return read_image(path, options); })));
                             });
    module.verb<ReadOptions>("read_texture", {{"path", kPath}}, "Texture", "A texture with all its levels.",
                             [](Call& call, ReadOptions& options) -> py::object {
                                 const std::string path = path_from(call["path"], "path");
                                 return object_of(value_of(without_gil([&] { return read_texture(path, options); })));
                             });
    module.verb<ReadOptions>(
        "decode_file", {{"data", "Buffer"}, {"name", "str", "'memory'"}}, "Texture",
        "The same for a file in memory: bytes, or another buffer. Errors call it `name`.",
        [](Call& call, ReadOptions& options) -> py::object {
            const std::vector<std::byte> bytes = bytes_from(call["data"], "data");
            const std::string name = call.has("name") ? text_from(call["name"], "name") : "memory";
            return object_of(value_of(without_gil([&] { return read_texture(bytes, name, options); })));
        });
    module.verb<ReadOptions>("probe", {{"path", kPath}}, "tuple[int, int]", "(width, height) in texels.",
                             [](Call& call, ReadOptions& options) -> py::object {
                                 const std::string path = path_from(call["path"], "path");
                                 return tuple_of(value_of(without_gil([&] { return probe(path, options); })));
                             });
    module.verb<ReadOptions>("reader_info", {}, "dict[str, Any]", "A dict of the fields of ReaderInfo.",
                             [](Call&, ReadOptions& options) -> py::object {
                                 const ReaderInfo info = value_of(without_gil([&] { return reader_info(options); }));
                                 py::dict facts;
                                 facts["program"] = info.program;
                                 facts["openimageio"] = info.openimageio;
                                 facts["landlock"] = info.landlock;
                                 facts["files_restricted"] = info.files_restricted;
                                 facts["calls_filtered"] = info.calls_filtered;
                                 return facts;
                             });
    module.verb<NormalsKeywords, Running>(
        "read_normals", {{"path", kPath}, {"base_only", "bool", "False"}},
        "tuple[list[NDArray[np.float32]], dict[str, Any]]",
        "(chain, info): a list of arrays, one for each level, with y up, and a dict of the fields of SourceInfo. "
        "Levels "
        "with other data beside the normals are NormalMaps; unpack={'others': ['alpha', 'blue', 'length']} says which. "
        "Warns (UserWarning) if the file does not state the direction of y, and its texels show that green points "
        "down; "
        "unpack={'y_axis': 'down'} reads it so.",
        [](Call& call, NormalsKeywords& options, Running& running) -> py::object {
            const std::string path = path_from(call["path"], "path");
            const bool base_only = call.has("base_only") && Convert<bool>::from(call["base_only"], "base_only");
            Source source = running.run([&](const Execution& e) { return read_normals(path, options, base_only, e); });
            const py::dict info = describe(source.info);
            if (source.info.y_doubtful) warn_of_y(path);
            return py::make_tuple(arrays_of(std::move(source.chain)), info);
        });
}

void add_writing(Module& module) {
    module.verb<WriteOptions>("write_texture", {{"path", kPath}, {"texture", "Texture"}}, "None",
                              "The extension of the path decides the file type.",
                              [](Call& call, WriteOptions& options) -> py::object {
                                  const std::string path = path_from(call["path"], "path");
                                  const Texture& texture = texture_from(call["texture"], "texture");
                                  value_of(without_gil([&] { return write_texture(path, texture, options); }));
                                  return py::none();
                              });
    module.verb<WriteOptions>(
        "encode_file", {{"texture", "Texture"}, {"container", "str"}}, "bytes",
        "The bytes of a file of this type: 'dds', 'ktx2', 'png', 'exr', 'tiff', 'tga', 'bmp', 'jpeg', 'webp'.",
        [](Call& call, WriteOptions& options) -> py::object {
            const Texture& texture = texture_from(call["texture"], "texture");
            const Container container = container_from(call["container"]);
            return bytes_of(value_of(without_gil([&] { return encode_file(texture, container, options); })));
        });
    module.verb<WriteOptions>("write_file", {{"path", kPath}, {"data", "Buffer"}}, "None",
                              "`data` is bytes, or another buffer.",
                              [](Call& call, WriteOptions& options) -> py::object {
                                  const std::string path = path_from(call["path"], "path");
                                  const std::vector<std::byte> bytes = bytes_from(call["data"], "data");
                                  value_of(without_gil([&] { return write_file(path, bytes, options); }));
                                  return py::none();
                              });
}

// The questions about containers: whether one can hold an encoding or a format.
void add_containers(Module& module) {
    module.verb<>("container_of", {{"path", kPath}}, "str | None", "The file type's word, or None.",
                  [](Call& call) -> py::object {
                      const std::optional<Container> container = container_of(path_from(call["path"], "path"));
                      if (!container) return py::none();
                      return word_of(*container);
                  });
    module.verb<>("can_hold", {{"container", "str"}, {"what", "str"}}, "bool", "`what` is an encoding or a format.",
                  [](Call& call) -> py::object {
                      const Container container = container_from(call["container"]);
                      const std::string what = text_from(call["what"], "what");
                      if (const auto encoding = find_by_name(kEncodingNames, what))
                          return py::bool_(can_hold(container, *encoding));
                      return py::bool_(can_hold(container, Convert<Format>::from(call["what"], "what")));
                  });
    const auto question = [&module](const char* name, bool (*ask)(Container)) {
        module.verb<>(name, {{"container", "str"}}, "bool", "",
                      [ask](Call& call) -> py::object { return py::bool_(ask(container_from(call["container"]))); });
    };
    question("can_hold_levels", can_hold_levels);
    question("can_hold_blocks", can_hold_blocks);
    question("can_compress", can_compress);
    module.verb<>("default_encoding", {{"container", "str"}}, "str", "", [](Call& call) -> py::object {
        return word_of(default_encoding(container_from(call["container"])));
    });
}

}  // namespace

py::dict describe(const SourceInfo& info) {
    py::dict facts;
    facts["format"] = word_of(info.format);
    facts["swizzle"] = layout_name(info.swizzle);
    facts["guessed"] = info.guessed;
    facts["y_axis"] = word_of(info.y_axis);
    facts["y_known"] = info.y_known;
    facts["order_assumed"] = info.order_assumed;
    facts["y_doubtful"] = info.y_doubtful;
    facts["object_space"] = info.object_space;
    facts["z01"] = info.z01;
    facts["z_doubtful"] = info.z_doubtful;
    facts["not_finite"] = info.not_finite;
    facts["background"] = info.background;
    py::list others;
    for (const ExtraChannel& other : info.others) {
        py::dict channel;
        channel["name"] = std::string(1, other.name);
        channel["least"] = other.least;
        channel["greatest"] = other.greatest;
        others.append(channel);
    }
    facts["others"] = others;
    facts["srgb"] = info.srgb;
    facts["remarks"] = strs_of(info.remarks);
    return facts;
}

void add_files(Module& module) {
    add_reading(module);
    add_writing(module);
    add_containers(module);
}

}  // namespace tex::python
