// SPDX-License-Identifier: Apache-2.0
// arrays.h: numpy arrays and libtex's planes.
//
// From libtex to numpy nothing is copied: an array is a view of planes that it keeps alive. A map is (height, width, 3)
// over three planes, so its last stride is that of planes.
//
// From numpy to libtex:
//
//   maps that come from libtex, and views of them that keep rows of x, y and z apart: shared, not copied
//   planes of 32-bit floats in rows of a multiple of 16 texels                        shared, not copied
//   everything else: other strides, byte orders and types                            copied and converted
//
// Floats of 16 and 64 bits become floats of 32 bits. Integers of 8 and 16 bits become what read_image() makes of them:
// unsigned ones of n bits are divided by 2^n - 1, signed ones by 2^(n-1) - 1, and their lowest value is -1 too; maps
// must be floats. Other types raise TypeError, other shapes and values that are not finite ValueError.

#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <pybind11/numpy.h>
#include <tex/tex.h>

#include "arguments.h"

namespace tex::python {

// The types in stubs. tex/__init__.pyi defines them.
inline constexpr const char* kArray = "NDArray[np.float32]";
inline constexpr const char* kHeights = "ArrayLike | HeightField | Image | str | PathLike[str]";
inline constexpr const char* kMapSource = "ArrayLike | Image | Texture | str | PathLike[str]";
inline constexpr const char* kChainSource = "ArrayLike | Sequence[ArrayLike] | Image | Texture | str | PathLike[str]";
inline constexpr const char* kPicture = "ArrayLike | Image | str | PathLike[str]";
inline constexpr const char* kArrayMethod = "(self, dtype: Any = None, copy: bool | None = None) -> NDArray[Any]";

// What __array__(dtype, copy) returns, of an array.
[[nodiscard]] py::array array_as(const py::object& array, const py::object& dtype, const py::object& copy);

[[nodiscard]] py::array array_of(Plane<float> plane);  // (height, width)
[[nodiscard]] py::array array_of(NormalMap map);       // (height, width, 3); with others beside it, tex.NormalMap
[[nodiscard]] py::list arrays_of(MipChain chain);      // one array for each level

// An array over a plane that `owner` keeps alive.
[[nodiscard]] py::array view_of(PlaneView<float> plane, py::handle owner);

// A plane of an array (height, width). If it is shared, `from` must outlive it. `finite`: checked.
[[nodiscard]] Plane<float> plane_from(py::handle from, std::string_view name, bool finite = true);

// A picture of an array (height, width) or (height, width, channels), with the channels Y, RG, RGB or RGBA. Copied.
// Other names may be given, then for any number of channels.
[[nodiscard]] Image image_from(py::handle from, std::string_view name, const std::vector<std::string>& names = {});

// Any array. Raises TypeError if there is none, or if values are masked.
[[nodiscard]] py::array any_array_from(py::handle from, std::string_view name, std::string_view wanted = "an array");

// A map of an array (height, width, 3), or of what chain_of_source() takes. A tex.NormalMap has other data beside it.
enum class Sharing { reads, writes };  // a verb that writes into the map gets a copy
enum class Normals { finite, any };    // whether NaN and infinite components raise ValueError
[[nodiscard]] NormalMap map_from(py::handle from, std::string_view name, Sharing sharing = Sharing::reads,
                                 Normals normals = Normals::finite);

// A chain of an array, which becomes the only level, or of a sequence of arrays.
[[nodiscard]] MipChain chain_from(py::handle from, std::string_view name, Sharing sharing = Sharing::reads);

// Raises ValueError unless both have the same extent.
void need_equal(Extent a, Extent b, std::string_view name);

}  // namespace tex::python
