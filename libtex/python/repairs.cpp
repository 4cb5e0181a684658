// SPDX-License-Identifier: Apache-2.0
// What a check proves is undone.

#include <pybind11/stl.h>

#include "checks.h"
#include "modules.h"
#include "pickling.h"
#include "running.h"
#include "sources.h"
#include "values.h"

namespace tex::python {
namespace {

// The keywords of repair(), beside those of check().
struct Repairing {
    bool likely = false;
    py::object only = py::none(), skip = py::none();
    std::optional<MirroredChannel> mirrored;
    std::optional<TurnedPicture> turned;
    std::optional<float> bumpiness;
    Effort effort = RepairOptions{}.effort;
    MipOptions mip;
};

template <class F>
void each_field(Repairing& o, F& f) {
    f("likely", o.likely);
    f("only", o.only, "Sequence[str] | None");
    f("skip", o.skip, "Sequence[str] | None");
    f("mirrored", o.mirrored);
    f("turned", o.turned);
    f("bumpiness", o.bumpiness);
    f("effort", o.effort);
    f("mip", o.mip);
}

py::dict describe(const RepairStep& step) {
    py::dict facts;
    facts["rule"] = std::string(step.rule->id);
    facts["kind"] = word_of(step.kind);
    facts["certainty"] = word_of(step.certainty);
    facts["text"] = text_of(step);
    facts["channel"] = step.channel;
    facts["other"] = step.other;
    facts["part"] = step.part ? py::cast(*step.part) : py::none();
    facts["tone"] = step.tone ? py::object(py::make_tuple(step.tone->black, step.tone->white, step.tone->gamma))
                              : py::object(py::none());
    facts["tones"] = py::none();
    if (step.tones) {
        py::list tones;
        for (const ToneCurve& tone : *step.tones) tones.append(py::make_tuple(tone.black, tone.white, tone.gamma));
        facts["tones"] = tones;
    }
    facts["y"] = step.y ? py::object(word_of(*step.y)) : py::object(py::none());
    facts["degrees"] = step.degrees;
    return facts;
}

py::dict describe(Repaired done) {
    py::dict facts;
    facts["texture"] = py::none();
    if (done.texture) facts["texture"] = py::cast(std::make_shared<Texture>(std::move(*done.texture)));
    py::list steps, left;
    for (const RepairStep& step : done.steps) steps.append(describe(step));
    for (const FaultLeft& fault : done.left) left.append(py::make_tuple(fault.finding, word_of(fault.certainty)));
    facts["steps"] = steps;
    facts["left"] = left;
    facts["before"] = py::cast(std::make_shared<CheckReport>(std::move(done.before)));
    facts["after"] = py::cast(std::make_shared<CheckReport>(std::move(done.after)));
    return facts;
}

}  // namespace

void add_repairs(Module& module) {
    module.verb<Repairing, Checking, ReadKeyword, Running>(
        "repair", {{"what", "Texture | str | PathLike[str] | Image | ArrayLike"}, {"file", "str", "''"}},
        "dict[str, Any]",
        "Repairs a Texture, which reports call `file`, or what a file or an array holds, as check() takes it, with the "
        "arguments of check(). Returns a dict: `texture` is None if there was no step; `steps` are dicts with the "
        "fields of RepairStep; `left` has a Finding and its class for each fault that is left; `before` and `after` "
        "have the type CheckReport. `only` and `skip` list rules by id or name.",
        [](Call& call, Repairing& how, Checking& given, ReadKeyword& keyword, Running& running) -> py::object {
            const py::object what = call["what"];
            Checks checks;
            read_checks(given, checks);
            RepairOptions options;
            options.checks = checks.options;
            options.likely = how.likely;
            options.only = rules_from(how.only, "only");
            options.skip = rules_from(how.skip, "skip");
            options.mirrored = how.mirrored;
            options.turned = how.turned;
            options.bumpiness = how.bumpiness;
            options.effort = how.effort;
            options.mip = how.mip;
            std::string file = call.has("file") ? text_from(call["file"], "file") : "";
            std::optional<Texture> made;
            if (is_path(what)) {
                const std::string path = path_from(what, "what");
                if (file.empty()) file = path;
                made = running.run([&](const Execution&) { return read_texture(path, keyword.read); });
            } else if (!py::isinstance<Texture>(what)) {
                made = texture_of(what, "what");
            }
            const Texture& texture = made ? *made : texture_from(what, "what");
            return describe(running.run([&](const Execution& e) { return repair(file, texture, options, e); }));
        });
    module.verb<>("rule_repairs", {}, "list[dict[str, str]]", "A list of dicts with the fields of RuleRepair.",
                  [](Call&) -> py::object {
                      py::list all;
                      for (const RuleRepair& row : rule_repairs()) {
                          py::dict facts;
                          facts["rule"] = std::string(row.rule);
                          facts["certainty"] = word_of(row.certainty);
                          facts["kind"] = word_of(row.kind);
                          all.append(facts);
                      }
                      return all;
                  });
}

}  // namespace tex::python
