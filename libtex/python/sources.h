// SPDX-License-Identifier: Apache-2.0
// sources.h: files, pictures and textures in places where verbs take arrays.

#pragma once

#include <optional>
#include <string_view>

#include <pybind11/pybind11.h>
#include <tex/tex.h>

namespace tex::python {

namespace py = pybind11;

// The normals of a path (as read_normals() reads it), of an Image or a Texture (as unpack() does), y up; nullopt for
// all else. `base_only`: the base level will do.
[[nodiscard]] std::optional<MipChain> chain_of_source(py::handle from, bool base_only);

// The heights of a path or an Image, as height_field() makes them; nullopt for all else.
[[nodiscard]] std::optional<HeightField> field_of_source(py::handle from);

// The texture of one level that holds the channels of an Image, or of an array (height, width, channels).
[[nodiscard]] Texture texture_of(py::handle from, std::string_view name);

}  // namespace tex::python
