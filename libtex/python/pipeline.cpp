// SPDX-License-Identifier: Apache-2.0
// From file to file, row by row.

#include <cmath>

#include <fmt/format.h>
#include <pybind11/stl.h>

#include "modules.h"
#include "running.h"
#include "values.h"

namespace tex::python {
namespace {

constexpr const char* kPath = "str | PathLike[str]";

// The file type of an output: the extension's, unless a word is given.
struct Output {
    std::string path;
    Container container = Container::dds;
};

Output output_of(Call& call) {
    Output output{path_from(call["output"], "output")};
    if (call.has("container")) {
        output.container = Convert<Container>::from(call["container"], "container");
    } else if (const std::optional<Container> named = container_of(output.path)) {
        output.container = *named;
    } else {
        raise(Error{ErrorCode::bad_option, output.path, "the extension names no file type; give it as container"});
    }
    return output;
}

std::vector<Parameter> files() { return {{"input", kPath}, {"output", kPath}, {"container", "str | None", "None"}}; }

// How a file is packed, given what is known about its source.
PackOptions pack_options(const PackFields& fields, Container container, YAxis y, bool y_known) {
    PackOptions options;
    options.encoding = fields.encoding.value_or(default_encoding(container));
    options.y_axis = fields.y_axis.value_or(y);
    options.y_known = fields.y_axis.has_value() || y_known;
    options.effort = fields.effort;
    options.metric = fields.metric;
    options.rdo = fields.rdo;
    return options;
}

std::function<PackOptions(const SourceInfo&)> pack_by(const PackFields& fields, Container container) {
    return [=](const SourceInfo& info) { return pack_options(fields, container, info.y_axis, info.y_known); };
}

constexpr const char* kOthers = "dict[str, ArrayLike | float | str] | None";

// The data of a dict: of each of blue, alpha and length a number, an array (height, width), or a word: 'heights' or
// 'occlusion'.
ExtraInputs extras_from(py::handle given, bool has_heights) {
    ExtraInputs inputs;
    if (given.is_none()) return inputs;
    if (!py::isinstance<py::dict>(given)) raise_type("others", "a dict of 'blue', 'alpha' and 'length'", given);
    for (const auto& [key, value] : py::reinterpret_borrow<py::dict>(given)) {
        const std::string word = text_from(key, "others");
        const std::string name = fmt::format("others['{}']", word);
        ExtraData& data = inputs[extra_from(word, "others")].emplace();
        if (py::isinstance<py::str>(value)) {
            const std::string what = text_from(value, name);
            need(has_heights && (what == "heights" || what == "occlusion"), name,
                 has_heights ? "the word is 'heights' or 'occlusion'" : "must be a number or an array");
            (what == "heights" ? data.heights : data.occlusion) = true;
        } else if (py::isinstance<py::float_>(value) || py::isinstance<py::int_>(value)) {
            data.value = Convert<float>::from(value, name);
        } else {
            const auto plane = std::make_shared<Plane<float>>(plane_from(value, name).clone());
            data.map = [plane]() -> Result<Plane<float>> { return plane->clone(); };
        }
    }
    return inputs;
}

template <class Report>
py::dict written(const Report& report) {
    py::dict facts;
    facts["extent"] = tuple_of(report.extent);
    facts["levels"] = report.levels;
    facts["bytes"] = report.bytes;
    if (report.rdo) {
        py::dict angles;
        angles["plain_mean"] = report.rdo->plain_mean;
        angles["mean"] = report.rdo->mean;
        angles["most_growth"] = report.rdo->most_growth;
        angles["most_raised"] = report.rdo->most_raised;
        facts["rdo"] = angles;
    }
    return facts;
}

// What is written of a map that was read.
template <class Report>
py::dict written_map(const Report& report) {
    py::dict facts = written(report);
    facts["encoding"] = word_of(report.pack.encoding);
    facts["y_axis"] = word_of(report.pack.y_axis);
    facts["source"] = describe(report.source);
    return facts;
}

// The keywords of a verb from file to file.
template <class Options>
struct FileFields {
    Options file;
    PackFields pack;
    py::object others = py::none();
};

struct BakeFields : FileFields<BakeFileOptions> {
    std::optional<float> bumpiness_x, bumpiness_y;  // without them, what the file states
};

template <class F>
void each_field(BakeFields& o, F& f) {
    f("bumpiness", axes(o.bumpiness_x, o.bumpiness_y));
    f("vertical_scale", o.file.vertical_scale);
    f("read", o.file.read);
    f("color", o.file.color);
    f("heights", o.file.heights);
    f("bake", o.file.bake);
    f("mip", o.file.mip);
    f("pack", o.pack);
    f("write", o.file.write);
    f("others", o.others, kOthers);
    f("slopes", o.file.slopes);
}

py::object baked(Call& call, BakeFields& fields, Running& running) {
    BakeFileOptions& options = fields.file;
    const std::string input = path_from(call["input"], "input");
    const Output output = output_of(call);
    if (fields.bumpiness_x || fields.bumpiness_y) {
        const Strength strength{fields.bumpiness_x.value_or(1.0f), fields.bumpiness_y.value_or(1.0f)};
        need(std::isfinite(strength.x) && std::isfinite(strength.y), "bumpiness", "must be finite");
        options.strength = [strength](Extent) { return strength; };
    }
    options.pack = pack_options(fields.pack, output.container, YAxis::up, true);
    options.others = extras_from(fields.others, true);
    const BakeFileReport report =
        running.run([&](const Execution& e) { return bake_file(input, output.path, output.container, options, e); });
    py::dict facts = written(report);
    facts["luma_texels"] = report.heights.luma_texels;
    facts["invalid_texels"] = report.heights.invalid_texels;
    facts["implausible_texels"] = report.heights.implausible_texels;
    facts["stored"] = report.heights.stored;
    facts["remark"] = str_of(report.heights.remark);
    facts["ground"] = object_of(report.heights.ground);
    facts["ground_remark"] = str_of(report.heights.ground_remark);
    facts["on_ground"] = report.on_ground;
    facts["steep_texels"] = report.steep_texels;
    if (options.slopes) {
        py::dict slopes;
        slopes["x"] = py::make_tuple(report.slopes.min_x, report.slopes.max_x);
        slopes["y"] = py::make_tuple(report.slopes.min_y, report.slopes.max_y);
        facts["slopes"] = slopes;
    }
    return facts;
}

using RepackFields = FileFields<PackFileOptions>;

template <class F>
void each_field(RepackFields& o, F& f) {
    f("source", o.file.source);
    f("level", o.file.level);
    f("scale", o.file.scale);
    f("mip", o.file.mip);
    f("max_side", o.file.max_side);
    f("keep_codes", o.file.keep_codes);
    f("pack", o.pack);
    f("write", o.file.write);
    f("others", o.others, kOthers);
}

py::object repacked(Call& call, RepackFields& fields, Running& running) {
    PackFileOptions& options = fields.file;
    const std::string input = path_from(call["input"], "input");
    const Output output = output_of(call);
    options.pack = pack_by(fields.pack, output.container);
    options.others = extras_from(fields.others, false);
    const PackFileReport report =
        running.run([&](const Execution& e) { return pack_file(input, output.path, output.container, options, e); });
    return written_map(report);
}

using BlendFields = FileFields<BlendFileOptions>;

template <class F>
void each_field(BlendFields& o, F& f) {
    f("source", o.file.source);
    f("blend", o.file.blend);
    f("mip", o.file.mip);
    f("pack", o.pack);
    f("write", o.file.write);
    f("others", o.others, kOthers);
}

LayerFile layer_from(py::handle given, const std::string& name) {
    if (!py::isinstance<py::dict>(given)) raise_type(name, "a dict with 'input' and the fields of LayerFile", given);
    const py::dict fields = py::reinterpret_steal<py::dict>(PyDict_Copy(given.ptr()));
    need(fields.contains("input"), name, "needs 'input', a file");
    LayerFile layer;
    layer.input = path_from(fields.attr("pop")("input"), name + "['input']");
    Reader reader(fields);
    reader("source", layer.source);
    each_placement(layer, reader);
    reader.finish(name);
    return layer;
}

py::object blended(Call& call, BlendFields& fields, Running& running) {
    BlendFileOptions& options = fields.file;
    need((options.blend.extent.width == 0) == (options.blend.extent.height == 0), "blend",
         "both sides of extent or neither must be 0");
    const py::object layers = call["layers"];
    if (!py::isinstance<py::list>(layers) && !py::isinstance<py::tuple>(layers))
        raise_type("layers", "a list of dicts", layers);
    for (const py::handle layer : layers)
        options.layers.push_back(layer_from(layer, fmt::format("layers[{}]", options.layers.size())));
    const std::string input = path_from(call["input"], "input");
    const Output output = output_of(call);
    options.pack = pack_by(fields.pack, output.container);
    options.others = extras_from(fields.others, false);
    const BlendFileReport report =
        running.run([&](const Execution& e) { return blend_file(input, output.path, output.container, options, e); });
    py::dict facts = written_map(report);
    py::list details;
    for (const SourceInfo& info : report.details) details.append(describe(info));
    facts["details"] = details;
    return facts;
}

constexpr const char* kNotes =
    "The extension of `output` decides the file type, unless `container` does. Structures are dicts with the names of "
    "their fields: mip={'filter': 'kaiser'}. Without pack={'encoding': ...}, the file gets its default_encoding(). "
    "`others` is a dict of data that go into 'blue', 'alpha' or 'length': an array (height, width), a number from 0 to "
    "1, or, of bake_file(), 'heights'. "
    "Returns a dict of facts about the result. Several outputs, one file for each level, and roughness maps: use "
    "run().";

}  // namespace

void add_pipeline(Module& module) {
    module.verb<BakeFields, Running>("bake_file", files(), "dict[str, Any]", kNotes, baked);
    module.verb<RepackFields, Running>("pack_file", files(), "dict[str, Any]", kNotes, repacked);
    std::vector<Parameter> parameters = files();
    parameters.insert(parameters.begin() + 1, {"layers", "Sequence[dict[str, Any]]"});
    module.verb<BlendFields, Running>("blend_file", parameters, "dict[str, Any]", kNotes, blended);
}

}  // namespace tex::python
