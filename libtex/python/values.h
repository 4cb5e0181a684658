// SPDX-License-Identifier: Apache-2.0
// values.h: the classes Image, HeightField and Texture, and what verbs accept in their places.

#pragma once

#include <memory>
#include <optional>
#include <string_view>

#include <tex/tex.h>

#include "arrays.h"
#include "verb.h"

namespace tex::python {

// The field that bake() reads: a HeightField, or an array, a path or an Image with bumpiness 1 that repeats; `relief`
// takes precedence. `finite`: whether it is checked for NaN and infinities.
[[nodiscard]] HeightField field_from(py::handle from, std::string_view name, const Relief& relief = {},
                                     bool finite = true);

// An Image, an array, or a path that read_image() reads.
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
// A dict of its fields, or None.
[[nodiscard]] py::object object_of(const std::optional<Ground>& ground);
[[nodiscard]] py::object object_of(Image image);
[[nodiscard]] py::object object_of(HeightField field);
[[nodiscard]] py::object object_of(Texture texture);

// The encoding that has this format and this swizzle, or None.
[[nodiscard]] py::object encoding_of(const Texture& texture);

// Raises ValueError unless it is a picture as preview() makes it: rgb8, one level.
void need_picture(const Texture& texture, std::string_view name);

[[nodiscard]] std::vector<std::byte> bytes_from(py::handle given, std::string_view name);
// A PNG of the channels R, G and B, or of the first one in grey.
[[nodiscard]] Result<std::vector<std::byte>> png_of(const Image& image);
py::bytes bytes_of(const std::vector<std::byte>& bytes);

}  // namespace tex::python
