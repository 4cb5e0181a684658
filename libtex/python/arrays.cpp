// SPDX-License-Identifier: Apache-2.0
#include "arrays.h"

#include <memory>
#include <utility>

#include <fmt/format.h>

#include "finite.h"
#include "gil.h"
#include "sources.h"

namespace tex::python {
namespace {

constexpr const char* kOwner = "tex.planes";  // the name of capsules that keep planes
constexpr py::ssize_t kFloat = static_cast<py::ssize_t>(sizeof(float));
constexpr std::ptrdiff_t kRowFloats = static_cast<std::ptrdiff_t>(kRowAlignment) / kFloat;

using Owner = std::shared_ptr<void>;

// A capsule that keeps `owner`.
py::capsule capsule_of(Owner owner) {
    auto kept = std::make_unique<Owner>(std::move(owner));
    py::capsule capsule(kept.get(), kOwner,
                        [](PyObject* self) { delete static_cast<Owner*>(PyCapsule_GetPointer(self, kOwner)); });
    static_cast<void>(kept.release());
    return capsule;
}

// What keeps the memory of an array that array_of() has made, or of a view of one; null for other arrays.
Owner owner_of(const py::array& array) {
    py::object base = array.base();
    while (base && py::isinstance<py::array>(base)) base = py::reinterpret_borrow<py::array>(base).base();
    if (!base || PyCapsule_IsValid(base.ptr(), kOwner) == 0) return nullptr;
    return *static_cast<Owner*>(PyCapsule_GetPointer(base.ptr(), kOwner));
}

std::string shape_of(const py::array& array) { return py::str(py::object(array.attr("shape"))); }

// The sides of an array of two or three axes.
Extent sides_of(const py::array& array, std::string_view name) {
    for (const int axis : {0, 1}) {
        if (array.shape(axis) < 1 || array.shape(axis) > kMaxExtent)
            throw py::value_error(
                fmt::format("{}: sides are 1 to {} texels, got {}", name, kMaxExtent, shape_of(array)));
    }
    return {static_cast<int>(array.shape(1)), static_cast<int>(array.shape(0))};
}

Extent extent_of(const py::array& array, std::string_view name, py::ssize_t dimensions, std::string_view wanted) {
    if (array.ndim() != dimensions || (dimensions == 3 && array.shape(2) != 3))
        throw py::value_error(fmt::format("{}: expected an array of shape {}, got {}", name, wanted, shape_of(array)));
    return sides_of(array, name);
}

// Floats in this machine's order, with strides of whole floats, at an address of a float.
bool is_plain(const py::array& array) {
    if (!py::isinstance<py::array_t<float>>(array)) return false;
    if (reinterpret_cast<std::uintptr_t>(array.data()) % sizeof(float) != 0) return false;
    for (py::ssize_t axis = 0; axis < array.ndim(); ++axis) {
        if (array.strides(axis) % kFloat != 0) return false;
    }
    return true;
}

// The array as floats that is_plain() accepts: itself or a converted copy.
py::array floats_of(const py::array& array, std::string_view name, bool is_map) {
    if (is_plain(array)) return array;
    const char kind = array.dtype().kind();
    const py::ssize_t bytes = array.itemsize();
    const bool integers = (kind == 'u' || kind == 'i') && bytes <= 2;
    if (is_map && integers) {
        throw py::type_error(fmt::format("{}: values of the type {} are stored colours; unpack() makes normals of them",
                                         name, std::string(py::str(array.dtype()))));
    }
    if (!integers && !(kind == 'f' && bytes <= 8)) {
        throw py::type_error(
            fmt::format("{}: cannot use values of the type {}; convert them to float32{}", name,
                        std::string(py::str(array.dtype())),
                        is_map ? "" : ", or to an integer type of 8 or 16 bits, whose largest value is 1"));
    }
    const py::dtype float32("float32");
    py::object floats = call_method(array, "astype", float32);
    if (integers) {
        const auto bits = static_cast<int>(8 * bytes) - (kind == 'i' ? 1 : 0);
        floats = call_method(floats, "__truediv__", float32.attr("type")((1 << bits) - 1));
        // The lowest code is -1, too, as in files.
        if (kind == 'i') floats = call_method(floats, "clip", float32.attr("type")(-1));
    }
    return floats;
}

py::array array_from(py::handle from, std::string_view name, bool is_map) {
    return floats_of(any_array_from(from, name), name, is_map);
}

// Plane `axis` of the last axis of an array of three axes, or the whole array of two.
struct Strided {
    const float* data;
    std::ptrdiff_t row, column;  // in floats
};

Strided strided(const py::array& array, py::ssize_t plane) {
    const auto* const data = static_cast<const float*>(array.data());
    const std::ptrdiff_t offset = array.ndim() == 3 ? plane * (array.strides(2) / kFloat) : 0;
    return {data + offset, array.strides(0) / kFloat, array.strides(1) / kFloat};
}

void copy_to(Plane<float>& plane, Strided from) {
    const Extent extent = plane.extent();
    for (int j = 0; j < extent.height; ++j) {
        float* const to = plane.row(j);
        const float* const row = from.data + j * from.row;
        for (int i = 0; i < extent.width; ++i) to[i] = row[i * from.column];
    }
}

void need_finite(bool finite, std::string_view name, const char* remedy = "") {
    if (!finite) raise_value(name, std::string("some values are infinite or NaN") + remedy);
}

}  // namespace

py::array any_array_from(py::handle from, std::string_view name, std::string_view wanted) {
    if (from.is_none()) raise_type(name, wanted, from);
    const py::module_ numpy = py::module_::import("numpy.ma");
    if (py::isinstance(from, numpy.attr("MaskedArray")) && numpy.attr("is_masked")(from).cast<bool>()) {
        throw py::type_error(
            fmt::format("{}: some values are masked, and a mask would be lost; array.filled() replaces "
                        "them. Of heights, height_field() with fill_invalid=True fills in NaN: "
                        "array.astype('float32').filled(float('nan'))",
                        name));
    }
    const py::array array = py::array::ensure(from);
    if (!array) {
        PyErr_Clear();
        raise_type(name, wanted, from);
    }
    return array;
}

py::array array_as(const py::object& array, const py::object& dtype, const py::object& copy) {
    const py::object own = array.attr("dtype");
    const py::object wanted = dtype.is_none() ? own : py::module_::import("numpy").attr("dtype")(dtype);
    if (copy.ptr() == Py_False && !wanted.equal(own)) throw py::value_error("these values need a copy");
    return array.attr("astype")(wanted, py::arg("copy") = copy.ptr() == Py_True);
}

py::array view_of(PlaneView<float> plane, py::handle owner) {
    const Extent extent = plane.extent;
    return py::array(py::dtype::of<float>(), {py::ssize_t{extent.height}, py::ssize_t{extent.width}},
                     {plane.stride * kFloat, kFloat}, plane.data, owner);
}

py::array array_of(Plane<float> plane) {
    const auto kept = std::make_shared<Plane<float>>(std::move(plane));
    return view_of(kept->view(), capsule_of(kept));
}

namespace {

py::object normal_map_class() { return py::module_::import("tex._normal_map").attr("NormalMap"); }

py::array normals_of(NormalMap map) {
    auto kept = std::make_shared<NormalMap>(std::move(map));
    const auto address = [](Plane<float>& plane) { return reinterpret_cast<std::intptr_t>(plane.row(0)); };
    const std::intptr_t step = address(kept->y) - address(kept->x);
    const Extent extent = kept->extent();
    if (address(kept->z) - address(kept->y) != step || kept->y.stride() != kept->x.stride() ||
        kept->z.stride() != kept->x.stride()) {
        const auto joined = std::make_shared<NormalMap>(extent);
        copy_to(joined->x, {kept->x.row(0), kept->x.stride(), 1});
        copy_to(joined->y, {kept->y.row(0), kept->y.stride(), 1});
        copy_to(joined->z, {kept->z.row(0), kept->z.stride(), 1});
        return normals_of(std::move(*joined));
    }
    return py::array(py::dtype::of<float>(), {py::ssize_t{extent.height}, py::ssize_t{extent.width}, py::ssize_t{3}},
                     {kept->x.stride() * kFloat, kFloat, static_cast<py::ssize_t>(step)}, kept->x.row(0),
                     capsule_of(kept));
}

}  // namespace

py::array array_of(NormalMap map) {
    py::dict extras;
    for (const auto& [extra, name, meaning] : kExtraNames) {
        if (!map[extra].empty()) extras[py::str(std::string(name))] = array_of(std::move(map[extra]));
    }
    py::array normals = normals_of(std::move(map));
    if (extras.empty()) return normals;
    return normal_map_class()(normals, **extras);
}

py::list arrays_of(MipChain chain) {
    py::list levels;
    for (NormalMap& level : chain.levels) levels.append(array_of(std::move(level)));
    return levels;
}

Image image_from(py::handle from, std::string_view name, const std::vector<std::string>& names) {
    const py::array given = any_array_from(from, name);
    const py::array array = floats_of(given, name, false);
    const py::ssize_t channels = array.ndim() == 3 ? array.shape(2) : 1;
    if ((array.ndim() != 2 && array.ndim() != 3) || channels < 1 || (channels > 4 && names.empty())) {
        throw py::value_error(
            fmt::format("{}: expected an array of shape (height, width) or (height, width, 1 to 4), got {}", name,
                        shape_of(array)));
    }
    need(names.empty() || names.size() == static_cast<std::size_t>(channels), "names",
         fmt::format("there must be {}, one for each channel", channels));
    Image image;
    const char kind = given.dtype().kind();
    image.sample = kind == 'u' ? SampleKind::unorm : kind == 'i' ? SampleKind::snorm : SampleKind::floating;
    image.bits = kind == 'f' ? (given.itemsize() == 2 ? 16 : 32) : static_cast<int>(8 * given.itemsize());
    const Extent extent = sides_of(array, name);
    for (py::ssize_t c = 0; c < channels; ++c) {
        image.planes.emplace_back(extent);
        copy_to(image.planes.back(), strided(array, c));
        image.names.emplace_back(!names.empty()  ? names[static_cast<std::size_t>(c)]
                                 : channels == 1 ? "Y"
                                                 : std::string(1, "RGBA"[c]));
    }
    return image;
}

Plane<float> plane_from(py::handle from, std::string_view name, bool finite) {
    const py::array array = array_from(from, name, false);
    const Extent extent = extent_of(array, name, 2, "(height, width)");
    const Strided texels = strided(array, 0);
    const bool shares =
        from.ptr() == array.ptr() && texels.column == 1 && texels.row >= extent.width && extent.width % kRowFloats == 0;
    Plane<float> plane;
    const bool sound = without_gil([&] {
        if (shares) {
            // Kernels read whole vectors, which end with the row, and nothing writes.
            plane = Plane<float>(extent, texels.row, std::shared_ptr<float>(Owner(), const_cast<float*>(texels.data)));
        } else {
            plane = Plane<float>(extent);
            copy_to(plane, texels);
        }
        return !finite || is_finite(plane.view());
    });
    need_finite(sound, name, "; height_field() with fill_invalid=True replaces them in heights");
    return plane;
}

namespace {

// A plane that stays where results keep it: shared if it is libtex's own, else copied.
Plane<float> kept_plane_from(const py::object& from, const std::string& name, Sharing sharing) {
    Plane<float> plane = plane_from(from, name);
    if (!py::isinstance<py::array>(from) || plane.row(0) != py::array(from).data()) return plane;  // it is a copy
    const Owner owner = sharing == Sharing::reads ? owner_of(py::array(from)) : nullptr;
    if (owner == nullptr) return plane.clone();
    return Plane<float>(plane.extent(), plane.stride(), std::shared_ptr<float>(owner, plane.row(0)));
}

void add_extras(py::handle from, std::string_view name, Sharing sharing, NormalMap& map) {
    if (!py::isinstance<py::array>(from) || !py::isinstance(from, normal_map_class())) return;
    for (const auto& [extra, word, meaning] : kExtraNames) {
        const py::object given = from.attr(py::str(std::string(word)));
        if (given.is_none()) continue;
        const std::string full = fmt::format("{}.{}", name, word);
        map[extra] = kept_plane_from(given, full, sharing);
        need_equal(map[extra].extent(), map.extent(), full);
    }
}

}  // namespace

NormalMap map_from(py::handle from, std::string_view name, Sharing sharing, Normals normals) {
    const bool any = normals == Normals::any;
    if (std::optional<MipChain> chain = chain_of_source(from, true)) return std::move(chain->levels.front());
    const py::array array = array_from(from, name, true);
    const Extent extent = extent_of(array, name, 3, "(height, width, 3)");
    const Owner owner = sharing == Sharing::reads ? owner_of(array) : nullptr;
    const auto address = reinterpret_cast<std::uintptr_t>(array.data());
    const bool shares = owner != nullptr && array.strides(1) == kFloat && array.strides(0) >= extent.width * kFloat &&
                        address % kRowAlignment == 0 &&
                        array.strides(0) % static_cast<py::ssize_t>(kRowAlignment) == 0 &&
                        array.strides(2) % static_cast<py::ssize_t>(kRowAlignment) == 0 && array.strides(2) != 0;
    NormalMap map;
    const bool finite = without_gil([&] {
        if (!shares) map = NormalMap(extent);
        bool sound = true;
        Plane<float>* const planes[] = {&map.x, &map.y, &map.z};
        for (const int c : {0, 1, 2}) {
            Plane<float>& plane = *planes[c];
            const Strided texels = strided(array, c);
            if (shares) {
                plane =
                    Plane<float>(extent, texels.row, std::shared_ptr<float>(owner, const_cast<float*>(texels.data)));
            } else {
                copy_to(plane, texels);
            }
            sound = sound && (any || is_finite(plane.view()));
        }
        return sound;
    });
    need_finite(finite, name);
    const bool is_base = name.find('[') == std::string_view::npos || name.ends_with("[0]");  // others may be short
    need(!is_base || !looks_like_colours(map), name,
         "values from 0 to 1 look like colours, (n + 1) / 2; unpack() makes normals of them");
    add_extras(from, name, sharing, map);
    return map;
}

MipChain chain_from(py::handle from, std::string_view name, Sharing sharing) {
    if (is_source(from)) raise_type(name, "an array, or a list of levels", from);
    if (std::optional<MipChain> chain = chain_of_source(from, false)) return std::move(*chain);
    MipChain chain;
    if (!py::isinstance<py::list>(from) && !py::isinstance<py::tuple>(from)) {
        chain.levels.push_back(map_from(from, name, sharing));
        return chain;
    }
    for (const py::handle level : from)
        chain.levels.push_back(map_from(level, fmt::format("{}[{}]", name, chain.levels.size()), sharing));
    need(!chain.levels.empty(), name, "there is no level");
    const Extent base = chain.levels.front().extent();
    need(static_cast<int>(chain.levels.size()) <= level_count(base), name, "there are more levels than a chain has");
    for (std::size_t k = 1; k < chain.levels.size(); ++k) {
        need_equal(chain.levels[k].extent(), level_extent(base, static_cast<int>(k)), fmt::format("{}[{}]", name, k));
    }
    return chain;
}

void need_equal(Extent a, Extent b, std::string_view name) {
    if (a == b) return;
    throw py::value_error(
        fmt::format("{}: expected {} x {} texels, got {} x {}", name, b.width, b.height, a.width, a.height));
}

}  // namespace tex::python
