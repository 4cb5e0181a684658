// SPDX-License-Identifier: Apache-2.0
// meshes.h: the classes Mesh, MeshPart and SelectedPart. Parts are checked when they are made, and cannot change.

#pragma once

#include <string_view>

#include <pybind11/numpy.h>
#include <tex/tex.h>

#include "verb.h"

namespace tex::python {

[[nodiscard]] const Mesh& mesh_from(py::handle from, std::string_view name);
[[nodiscard]] const MeshPart& part_from(py::handle from, std::string_view name);
[[nodiscard]] py::dict transform_of(const UvTransform& transform);
[[nodiscard]] const SelectedPart& selected_from(py::handle from, std::string_view name);

// An array of a row for each element: four columns for tangents. `tangents_of` copies, `tangents_from` does, too.
[[nodiscard]] py::array tangents_of(const std::vector<Float4>& tangents);
[[nodiscard]] std::vector<Float4> tangents_from(py::handle from, std::string_view name);

// The space of the part, which must outlive it.
[[nodiscard]] TangentSpace space_of(const SelectedPart& selected, Decoder decoder);

}  // namespace tex::python
