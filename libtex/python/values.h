// SPDX-License-Identifier: Apache-2.0
// values.h: the classes Image, HeightField and Texture, and what verbs accept in their places.

#pragma once

#include <memory>
#include <string_view>

#include <tex/tex.h>

#include "arrays.h"
#include "verb.h"

namespace tex::python {

// The field that bake() reads: a HeightField, or an array with bumpiness 1 that repeats; `relief` takes precedence.
// `finite`: whether an array is checked for NaN and infinities.
[[nodiscard]] HeightField field_from(py::handle from, std::string_view name, const Relief& relief = {},
                                     bool finite = true);

// An Image, or an array.
class Picture {
public:
    Picture(py::handle from, std::string_view name);
    [[nodiscard]] const Image& operator*() const { return *image_; }

private:
    std::shared_ptr<const Image> image_;
};

[[nodiscard]] const Texture& texture_from(py::handle from, std::string_view name);

// A new object of a class.
[[nodiscard]] py::dict dict_of(const AngularError& error);
[[nodiscard]] py::object object_of(Image image);
[[nodiscard]] py::object object_of(HeightField field);
[[nodiscard]] py::object object_of(Texture texture);

// The encoding that has this format and this swizzle, or None.
[[nodiscard]] py::object encoding_of(const Texture& texture);

// Raises ValueError unless it is a picture as preview() makes it: rgb8, one level.
void need_picture(const Texture& texture, std::string_view name);

py::bytes bytes_of(const std::vector<std::byte>& bytes);

}  // namespace tex::python
