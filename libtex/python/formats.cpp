// SPDX-License-Identifier: Apache-2.0
// Facts: formats, encodings, levels, versions.

#include <limits>

#include <pybind11/stl.h>

#include "modules.h"
#include "values.h"

namespace tex::python {
namespace {

py::object described(Call& call) {
    const FormatInfo info = format_info(Convert<Format>::from(call["format"], "format"));
    py::dict facts;
    facts["sample"] = word_of(info.sample);
    facts["channels"] = info.channels;
    facts["bits"] = info.bits;
    facts["block"] = tuple_of(info.block);
    facts["block_bytes"] = info.block_bytes;
    return facts;
}

Extent extent_from(Call& call, const char* name) {
    const Extent extent = Convert<Extent>::from(call[name], name);
    need(extent.width >= 1 && extent.height >= 1, name, "sides must be 1 texel or more");
    return extent;
}

void add_encodings(Module& module) {
    module.verb<>("encoding_info", {{"encoding", "str"}}, "tuple[str, str]", "(format, swizzle) of an encoding.",
                  [](Call& call) -> py::object {
                      const EncodingInfo info = encoding_info(Convert<Encoding>::from(call["encoding"], "encoding"));
                      return py::make_tuple(word_of(info.format), to_string(info.swizzle));
                  });
    module.verb<>("steepest_slope", {{"encoding", "str"}}, "float", "", [](Call& call) -> py::object {
        return py::float_(static_cast<double>(steepest_slope(Convert<Encoding>::from(call["encoding"], "encoding"))));
    });
    module.verb<>("layout_name", {{"swizzle", "str"}}, "str", "", [](Call& call) -> py::object {
        return py::str(layout_name(Convert<Swizzle>::from(call["swizzle"], "swizzle")));
    });
}

}  // namespace

void add_formats(Module& module) {
    module.verb<>("format_info", {{"format", "str"}}, "dict[str, Any]",
                  "A dict of the fields of FormatInfo: sample, channels, bits, block and block_bytes.", described);
    module.verb<>("format_of", {{"sample", "str"}, {"bits", "int"}, {"channels", "int"}}, "str | None", "",
                  [](Call& call) -> py::object {
                      const std::optional<Format> format = format_of(
                          Convert<SampleKind>::from(call["sample"], "sample"), Convert<int>::from(call["bits"], "bits"),
                          Convert<int>::from(call["channels"], "channels"));
                      if (!format) return py::none();
                      return word_of(*format);
                  });
    module.verb<>("level_bytes", {{"format", "str"}, {"extent", "tuple[int, int]"}}, "int", "",
                  [](Call& call) -> py::object {
                      const auto format = Convert<Format>::from(call["format"], "format");
                      return py::int_(level_bytes(format, extent_from(call, "extent")));
                  });
    module.verb<>("level_extent", {{"base", "tuple[int, int]"}, {"level", "int"}}, "tuple[int, int]", "",
                  [](Call& call) -> py::object {
                      constexpr int kMost = std::numeric_limits<int>::max();
                      const auto level = static_cast<int>(integer_from(call["level"], "level", 0, kMost));
                      return tuple_of(level_extent(extent_from(call, "base"), level));
                  });
    module.verb<>("level_count", {{"base", "tuple[int, int]"}}, "int", "",
                  [](Call& call) -> py::object { return py::int_(level_count(extent_from(call, "base"))); });
    add_encodings(module);
    module.verb<>("version", {}, "str", "", [](Call&) -> py::object { return py::str(version()); });
    module.verb<>("opencolorio_version", {}, "str", "",
                  [](Call&) -> py::object { return py::str(opencolorio_version()); });
    module.verb<>(
        "runtime", {}, "dict[str, Any]",
        "The environment of libtex on this machine: 'instruction_set' and 'dependencies', a dict of versions.",
        [](Call&) -> py::object {
            const Runtime now = runtime();
            py::dict facts, dependencies;
            for (const auto& [name, version] : now.dependencies) dependencies[py::str(name)] = version;
            facts["instruction_set"] = now.instruction_set;
            facts["dependencies"] = dependencies;
            return facts;
        });
}

}  // namespace tex::python
