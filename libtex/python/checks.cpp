// SPDX-License-Identifier: Apache-2.0
// What is wrong with a texture: rules, findings, reports.

#include <algorithm>
#include <cstdint>
#include <utility>

#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include "checks.h"
#include "meshes.h"
#include "modules.h"
#include "pickling.h"
#include "running.h"
#include "sources.h"
#include "values.h"

namespace tex::python {
namespace {

const py::dict dict_from(py::handle given, const char* name) {
    if (!py::isinstance<py::dict>(given)) raise_type(name, "a dict", given);
    return py::reinterpret_borrow<py::dict>(given);
}

}  // namespace

std::vector<std::string> rules_from(py::handle given, const char* name) {
    std::vector<std::string> rules;
    if (given.is_none()) return rules;
    if (!py::isinstance<py::list>(given) && !py::isinstance<py::tuple>(given))
        raise_type(name, "a list of rules", given);
    for (const py::handle rule : given) rules.push_back(text_from(rule, name));
    return rules;
}

void read_checks(const Checking& given, Checks& checks) {
    CheckOptions& options = checks.options;
    if (!given.require.is_none()) {
        for (const auto& [key, value] : dict_from(given.require, "require")) {
            std::string text = text_from(key, "require");
            for (char& c : text) c = c == '_' ? '-' : c;
            if (value.ptr() == Py_False) continue;
            if (py::isinstance<py::tuple>(value)) {  // (width, height)
                const auto extent = Convert<Extent>::from(value, "require");
                text += fmt::format("={}x{}", extent.width, extent.height);
            } else if (value.ptr() != Py_True) {
                text += "=" + std::string(py::str(value));
            }
            value_of(add_requirement(options.require, text));
        }
    }
    options.enable = rules_from(given.enable, "enable");
    options.disable = rules_from(given.disable, "disable");
    options.any_length = given.any_length;
    options.marks = given.marks;
    options.swizzle = given.swizzle;
    if (!given.severity.is_none()) {
        for (const auto& [rule, word] : dict_from(given.severity, "severity"))
            options.severity.emplace_back(text_from(rule, "severity"), Convert<Severity>::from(word, "severity"));
    }
    if (!given.height.is_none()) {
        checks.height = field_from(given.height, "height");
        options.height = &checks.height;
    }
    if (!given.occlusion.is_none()) {
        checks.occlusion = plane_from(given.occlusion, "occlusion");
        options.occlusion = &checks.occlusion;
    }
    options.occlusion_in_blue = given.occlusion_in_blue;
    if (!given.mesh.is_none()) {
        const SelectedPart& selected = selected_from(given.mesh, "mesh");
        options.mesh = &checks.mesh.emplace(MeshToCheck{selected, given.decoder});
    }
}

namespace {

// The keywords of check_model().
struct CheckingModels : Judging {
    std::string material;
    Decoder decoder = Decoder::gltf;
    std::optional<TangentSource> tangents;

    [[nodiscard]] Checking checks() const { return {*this}; }
};

template <class F>
void each_field(CheckingModels& o, F& f) {
    each_judging_field(o, f);
    f("material", o.material);
    f("decoder", o.decoder);
    f("tangents", o.tangents);
}

// A report without a file that could be read has nothing to say.
py::object sound(CheckReport report) {
    if (report.error) raise(*report.error);
    return py::cast(std::make_shared<CheckReport>(std::move(report)));
}

py::object checked_file(const py::object& path, Checking& given, ReadOptions& read, Running& running) {
    Checks checks;
    read_checks(given, checks);
    const std::string file = path_from(path, "path");
    return sound(running.run([&](const Execution& e) { return check_file(file, checks.options, read, e); }));
}

py::object marks_of(const Finding& finding) {
    if (!finding.marks) return py::none();
    const Marks& marks = *finding.marks;
    py::array_t<std::uint8_t> squares({marks.extent.height, marks.extent.width});
    std::transform(marks.squares.begin(), marks.squares.end(), squares.mutable_data(),
                   [](Mark mark) { return static_cast<std::uint8_t>(mark); });
    py::dict facts, texels;
    py::list names;
    for (const auto& row : kMarkNames) {
        names.append(std::string(row.name));
        texels[py::str(std::string(row.name))] = marks.count(row.value);
    }
    facts["squares"] = std::move(squares);
    facts["names"] = std::move(names);
    facts["side"] = marks.side;
    facts["texels"] = std::move(texels);
    return facts;
}

void add_findings(Module& module) {
    Class<Region>(module, "Region", "Texels of a level; y counts rows from the top.")
        .property("level", "int", "The level.", [](const Region& r) { return r.level; })
        .property("x", "int", "The first column.", [](const Region& r) { return r.x; })
        .property("y", "int", "The first row.", [](const Region& r) { return r.y; })
        .property("width", "int", "Columns.", [](const Region& r) { return r.width; })
        .property("height", "int", "Rows.", [](const Region& r) { return r.height; })
        .method("__repr__", "(self) -> str",
                [](const Region& r) {
                    return fmt::format("<tex.Region level {}: {}, {}, {} x {}>", r.level, r.x, r.y, r.width, r.height);
                })
        .copies()
        .finish();
    Class<Finding>(module, "Finding", "What is wrong, and where.")
        .property("id", "str", "The rule: 'N201'.", [](const Finding& f) { return std::string(f.rule->id); })
        .property("name", "str", "Its name: 'not-unit-length'.",
                  [](const Finding& f) { return std::string(f.rule->name); })
        .property("severity", "str", "'note', 'warning' or 'error'.",
                  [](const Finding& f) { return word_of(f.severity); })
        .property("level", "int", "The level of the first region; 0 if the finding concerns the whole file.",
                  [](const Finding& f) { return f.regions.empty() ? 0 : f.regions.front().level; })
        .property("message", "str", "A sentence with its figures.", [](const Finding& f) { return str_of(f.message); })
        .property("figure", "float", "What was measured, in `unit`.", [](const Finding& f) { return f.figure; })
        .property("unit", "str", "'share', 'degrees', 'texels', 'ratio', ... or empty.",
                  [](const Finding& f) { return std::string(f.unit); })
        .property("confidence", "float", "0.5 to 1; 1 if texels were counted.",
                  [](const Finding& f) { return f.confidence; })
        .property("regions", "list[Region]", "Where; empty for the whole file.",
                  [](const Finding& f) { return f.regions; })
        .property("fix_harms", "str",
                  "What the rule's fix would do to this map beside its purpose, as the rule tried; else empty.",
                  [](const Finding& f) { return str_of(f.fix_harms); })
        .property("marks", "dict[str, Any] | None",
                  "With check(marks=...): 'squares', an array (height, width) of numbers of 'names', the 'side' of a "
                  "square in texels, and 'texels', how many have each mark.",
                  [](const Finding& f) { return marks_of(f); })
        .property("texel", "tuple[int, int] | None", "(column, row) of the first affected texel.",
                  [](const Finding& f) -> py::object {
                      if (!f.has_texel) return py::none();
                      return py::make_tuple(f.column, f.row);
                  })
        .method("__repr__", "(self) -> str",
                [](const Finding& f) {
                    return str_of(fmt::format("<tex.Finding {} {}: {}>", f.rule->id,
                                              name_of(kSeverityNames, f.severity), f.message));
                })
        .copies()
        .finish();
}

py::object y_of(const YEvidence& y) {
    py::dict facts;
    facts["correlation"] = y.correlation;
    facts["confidence"] = y.confidence;
    facts["y"] = y.y ? py::object(word_of(*y.y)) : py::none();
    return facts;
}

py::object pair_of(const std::optional<PairEvidence>& pair) {
    if (!pair) return py::none();
    py::dict facts;
    facts["correlation"] = pair->correlation;
    facts["strength"] = pair->strength;
    facts["y"] = word_of(pair->y);
    facts["offset"] = py::make_tuple(pair->offset_x, pair->offset_y);
    return facts;
}

py::object occlusion_of(const std::optional<OcclusionEvidence>& occlusion) {
    if (!occlusion) return py::none();
    py::dict facts;
    facts["correlation"] = occlusion->correlation;
    facts["mirrored"] = py::make_tuple(occlusion->mirrored_x, occlusion->mirrored_y);
    facts["best"] = occlusion->best;
    return facts;
}

py::object seams_of(const std::optional<SeamEvidence>& seams) {
    if (!seams) return py::none();
    py::dict facts;
    facts["edges"] = seams->edges;
    facts["mean"] = seams->mean;
    facts["p99"] = seams->p99;
    facts["worst"] = seams->worst;
    facts["worst_edge"] = seams->worst_edge;
    facts["usual"] = seams->usual;
    return facts;
}

void add_report(Module& module) {
    Class<CheckReport>(module, "CheckReport", "The findings about a texture. Iterates over them.")
        .property("file", "str", "The file's name.", [](const CheckReport& r) { return str_of(r.file); })
        .property("map", "str", "Of a map in a model: its material and image; else empty.",
                  [](const CheckReport& r) { return str_of(r.map); })
        .property("material", "str", "Of such a map: its material, by name or number; empty if that has several maps.",
                  [](const CheckReport& r) { return str_of(r.material); })
        .property("findings", "list[Finding]", "By rule, then level.", [](const CheckReport& r) { return r.findings; })
        .property("explained", "int", "Findings left out because another one explains them.",
                  [](const CheckReport& r) { return r.explained; })
        .property("format", "str", "The format.", [](const CheckReport& r) { return word_of(r.format); })
        .property("swizzle", "str", "The layout that the file states or the texels suggest.",
                  [](const CheckReport& r) { return layout_name(r.swizzle); })
        .property("extent", "tuple[int, int]", "(width, height) of the base level.",
                  [](const CheckReport& r) { return tuple_of(r.extent); })
        .property("kind", "str",
                  "What the picture holds: 'normals', 'object-space', 'heights', 'grey' (of 8 bits), 'colour', 'data', "
                  "'one-colour', or 'unknown'.",
                  [](const CheckReport& r) { return str_of(std::string(name_of(kPictureKindNames, r.kind))); })
        .property("kind_confidence", "float", "That it is that kind, from 0.5 to 1.",
                  [](const CheckReport& r) { return r.kind_confidence; })
        .property(
            "height_bytes", "str | None",
            "How R, G and B hold heights, if they are the bytes of heights: 'terrain-rgb' or 'terrarium'.",
            [](const CheckReport& r) { return r.height_bytes ? py::object(word_of(*r.height_bytes)) : py::none(); })
        .property("levels", "int", "The number of levels.", [](const CheckReport& r) { return r.levels; })
        .property("more_data", "bool", "A channel varies that holds no component of the normals.",
                  [](const CheckReport& r) { return r.more_data; })
        .property("y", "dict[str, Any]", "The direction of green: the fields of YEvidence.",
                  [](const CheckReport& r) { return y_of(r.y); })
        .property("pair", "dict[str, Any] | None", "How the normals follow from the height map.",
                  [](const CheckReport& r) { return pair_of(r.pair); })
        .property("occlusion", "dict[str, Any] | None", "How the occlusion follows the normals.",
                  [](const CheckReport& r) { return occlusion_of(r.occlusion); })
        .property("seams", "dict[str, Any] | None", "How well the map fits the mesh: the fields of SeamEvidence.",
                  [](const CheckReport& r) { return seams_of(r.seams); })
        .property("y_on_mesh", "str | None", "Where green of the map points on the mesh.",
                  [](const CheckReport& r) { return r.y_on_mesh ? py::object(word_of(*r.y_on_mesh)) : py::none(); })
        .method("__iter__", "(self) -> Iterator[Finding]",
                [](const CheckReport& r) { return py::iter(py::cast(r.findings)); })
        .method("__len__", "(self) -> int", [](const CheckReport& r) { return r.findings.size(); })
        .method("__repr__", "(self) -> str",
                [](const CheckReport& r) {
                    return str_of(fmt::format("<tex.CheckReport {}: {} findings>", r.file, r.findings.size()));
                })
        .copies()
        .finish();
}

py::dict describe(const Rule& rule) {
    py::dict facts;
    facts["id"] = std::string(rule.id);
    facts["name"] = std::string(rule.name);
    facts["family"] = word_of(rule.family);
    facts["severity"] = word_of(rule.severity);
    facts["on"] = rule.on;
    facts["sentence"] = std::string(rule.sentence);
    facts["explanation"] = std::string(rule.explanation);
    facts["fix"] = std::string(rule.fix);
    return facts;
}

}  // namespace

void add_checks(Module& module) {
    add_findings(module);
    add_report(module);
    module.verb<Checking, ReadKeyword, Running>(
        "check", {{"what", "Texture | str | PathLike[str] | Image | ArrayLike"}, {"file", "str", "''"}}, "CheckReport",
        "Checks a Texture, which reports call `file`, or a file: check_file(). An Image, or an array (height, width, "
        "channels), counts as a file of one level: integers are stored colours, and floats are colours or components "
        "as in unpack(). Raises what reading raises, and CancelledError. `require` is a dict of requirements, "
        "{'y': 'up', 'mips': 'full', 'pow2': True}; `enable` and `disable` list rules by id or name; `severity` is a "
        "dict "
        "of rules and severities; `height` is the map's height map; `occlusion` is the occlusion beside it, which is "
        "in blue with `occlusion_in_blue`; `mesh` is the mesh that the map is on, from "
        "select_part(), and `decoder` the engine; with `any_length`, no rule judges the lengths of vectors, and "
        "`swizzle` names the layout; with `marks` above 0, findings have marks of at most so many squares on a side. "
        "Raises "
        "BadOptionError if a rule or a requirement "
        "does not exist.",
        [](Call& call, Checking& given, ReadKeyword& keyword, Running& running) -> py::object {
            const py::object what = call["what"];
            if (is_path(what)) return checked_file(what, given, keyword.read, running);
            Checks checks;
            read_checks(given, checks);
            std::optional<Texture> made;
            if (!py::isinstance<Texture>(what)) made = texture_of(what, "what");
            const Texture& texture = made ? *made : texture_from(what, "what");
            const std::string file = call.has("file") ? text_from(call["file"], "file") : "";
            return sound(running.run([&](const Execution& e) { return check(file, texture, checks.options, e); }));
        });
    module.verb<Checking, ReadKeyword, Running>(
        "check_file", {{"path", "str | PathLike[str]"}}, "CheckReport", "The arguments are those of check().",
        [](Call& call, Checking& given, ReadKeyword& keyword, Running& running) -> py::object {
            return checked_file(call["path"], given, keyword.read, running);
        });
    module.verb<CheckingModels, ReadKeyword, Running>(
        "check_model", {{"path", "str | PathLike[str]"}}, "list[CheckReport]",
        "`require`, `enable`, `disable` and `severity` are those of check(). An image that cannot be read gives a "
        "report "
        "with the finding N101.",
        [](Call& call, CheckingModels& given, ReadKeyword& keyword, Running& running) -> py::object {
            Checks checks;
            read_checks(given.checks(), checks);
            const std::string file = path_from(call["path"], "path");
            const ModelCheckOptions options{checks.options, given.material, given.decoder, given.tangents};
            py::list reports;
            for (CheckReport& report :
                 running.run([&](const Execution& e) { return check_model(file, options, keyword.read, e); }))
                reports.append(py::cast(std::make_shared<CheckReport>(std::move(report))));
            return reports;
        });
    module.verb<>("rules", {}, "list[dict[str, Any]]", "A list of dicts with the fields of Rule.",
                  [](Call&) -> py::object {
                      py::list all;
                      for (const Rule& rule : rules()) all.append(describe(rule));
                      return all;
                  });
    module.verb<>("find_rule", {{"id_or_name", "str"}}, "dict[str, Any] | None",
                  "A dict with the fields of Rule, or None.", [](Call& call) -> py::object {
                      const Rule* const rule = find_rule(text_from(call["id_or_name"], "id_or_name"));
                      if (rule == nullptr) return py::none();
                      return describe(*rule);
                  });
}

}  // namespace tex::python
