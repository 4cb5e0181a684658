// SPDX-License-Identifier: Apache-2.0
// checks.h: the arguments of check(), which repair() takes, too.

#pragma once

#include <optional>
#include <string>
#include <vector>

#include "meshes.h"
#include "sources.h"
#include "values.h"

namespace tex::python {

// Which rules count, and how much.
struct Judging {
    py::object require = py::none(), enable = py::none(), disable = py::none(), severity = py::none();
};

template <class F>
void each_judging_field(Judging& o, F& f) {
    f("require", o.require, "dict[str, str | int | bool] | None");
    f("enable", o.enable, "Sequence[str] | None");
    f("disable", o.disable, "Sequence[str] | None");
    f("severity", o.severity, "dict[str, str] | None");
}

// The keywords of check() and check_file().
struct Checking : Judging {
    py::object height = py::none(), occlusion = py::none(), mesh = py::none();
    bool any_length = false, occlusion_in_blue = false;
    int marks = 0;
    std::optional<Swizzle> swizzle = {};
    Decoder decoder = Decoder::gltf;
};

template <class F>
void each_field(Checking& o, F& f) {
    each_judging_field(o, f);
    f("height", o.height, "ArrayLike | HeightField | None");
    f("occlusion", o.occlusion, "ArrayLike | None");
    f("occlusion_in_blue", o.occlusion_in_blue);
    f("mesh", o.mesh, "SelectedPart | None");
    f("decoder", o.decoder);
    f("any_length", o.any_length);
    f("marks", o.marks);
    f("swizzle", o.swizzle);
}

// CheckOptions with what they refer to.
struct Checks {
    CheckOptions options;
    HeightField height;
    Plane<float> occlusion;
    std::optional<MeshToCheck> mesh;
};

struct ReadKeyword {
    ReadOptions read;
};

template <class F>
void each_field(ReadKeyword& o, F& f) {
    f("read", o.read);
}

// The rules of a list, or none.
std::vector<std::string> rules_from(py::handle given, const char* name);

void read_checks(const Checking& given, Checks& checks);

}  // namespace tex::python
