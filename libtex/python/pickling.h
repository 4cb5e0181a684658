// SPDX-License-Identifier: Apache-2.0
// pickling.h: the classes as tuples of Python values, for pickle and copy.
//
// each_part() lists the members of a structure once; Saver and Loader go through the list.

#pragma once

#include <array>
#include <cstring>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include <tex/tex.h>

#include "arguments.h"

namespace tex::python {

class Saver {
public:
    template <class... T>
    void operator()(const T&... parts) {
        (parts_.append(saved(parts)), ...);
    }
    [[nodiscard]] py::tuple parts() const { return parts_; }

    template <class T>
    static py::object saved(const T& value);

private:
    static py::bytes bytes_of(const void* data, std::size_t count) { return {static_cast<const char*>(data), count}; }
    py::list parts_;
};

class Loader {
public:
    explicit Loader(const py::handle& parts) : parts_(py::reinterpret_borrow<py::object>(parts)) {
        need(py::isinstance<py::tuple>(parts), "pickle", "damaged");
    }
    template <class... T>
    void operator()(T&... parts) {
        (load(parts_[py::int_(next_++)], parts), ...);
    }

    template <class T>
    static void load(const py::object& from, T& value);

private:
    // Raises ValueError unless `from` is bytes, a multiple of `step` of them.
    static std::string bytes_from(const py::object& from, std::size_t step) {
        need(py::isinstance<py::bytes>(from), "pickle", "damaged");
        std::string bytes = py::reinterpret_borrow<py::bytes>(from);
        need(bytes.size() % step == 0, "pickle", "damaged");
        return bytes;
    }
    py::object parts_;
    std::size_t next_ = 0;
};

template <class T>
concept Parted = requires(T& value, Loader& loader) {
    each_part(value, loader);
};

template <class T>
struct IsVector : std::false_type {};
template <class T>
struct IsVector<std::vector<T>> : std::true_type {};
template <class T>
struct IsMaybe : std::false_type {};
template <class T>
struct IsMaybe<std::optional<T>> : std::true_type {};

template <class T>
py::object Saver::saved(const T& value) {
    if constexpr (Parted<T>) {
        Saver inner;
        each_part(const_cast<T&>(value), inner);
        return inner.parts();
    } else if constexpr (std::is_same_v<T, std::string>) {
        return bytes_of(value.data(), value.size());
    } else if constexpr (std::is_same_v<T, Plane<float>>) {
        Saver rows;
        rows(value.extent());
        const std::size_t count = static_cast<std::size_t>(value.extent().width) * sizeof(float);
        std::string bytes;
        for (int j = 0; j < value.extent().height; ++j)
            bytes.append(reinterpret_cast<const char*>(value.row(j)), count);
        rows(bytes);
        return rows.parts();
    } else if constexpr (IsMaybe<T>::value) {
        if (!value) return py::none();
        return py::make_tuple(saved(*value));
    } else if constexpr (IsVector<T>::value) {
        using Each = typename T::value_type;
        if constexpr (!Parted<Each> && std::is_trivially_copyable_v<Each>) {
            return bytes_of(value.data(), value.size() * sizeof(Each));
        } else {
            Saver inner;
            for (const auto& each : value) inner(each);
            return inner.parts();
        }
    } else {
        static_assert(std::is_trivially_copyable_v<T>);
        return bytes_of(&value, sizeof value);
    }
}

template <class T>
void Loader::load(const py::object& from, T& value) {
    if constexpr (Parted<T>) {
        Loader inner(from);
        each_part(value, inner);
    } else if constexpr (std::is_same_v<T, std::string>) {
        value = bytes_from(from, 1);
    } else if constexpr (std::is_same_v<T, Plane<float>>) {
        Loader inner(from);
        Extent extent;
        std::string bytes;
        inner(extent);
        inner(bytes);
        const std::size_t count = static_cast<std::size_t>(extent.width) * sizeof(float);
        need(extent.width >= 1 && extent.height >= 1 && extent.width <= kMaxExtent && extent.height <= kMaxExtent &&
                 bytes.size() == count * static_cast<std::size_t>(extent.height),
             "pickle", "damaged");
        value = Plane<float>(extent);
        for (int j = 0; j < extent.height; ++j)
            std::memcpy(value.row(j), bytes.data() + static_cast<std::size_t>(j) * count, count);
    } else if constexpr (IsMaybe<T>::value) {
        value.reset();
        if (!from.is_none()) load(py::object(from[py::int_(0)]), value.emplace());
    } else if constexpr (IsVector<T>::value) {
        using Each = typename T::value_type;
        if constexpr (!Parted<Each> && std::is_trivially_copyable_v<Each>) {
            const std::string bytes = bytes_from(from, sizeof(Each));
            value.resize(bytes.size() / sizeof(Each));
            if (!bytes.empty()) std::memcpy(static_cast<void*>(value.data()), bytes.data(), bytes.size());
        } else {
            Loader inner(from);
            value.clear();
            for (std::size_t k = 0; k < py::len(from); ++k) inner(value.emplace_back());
        }
    } else {
        const std::string bytes = bytes_from(from, sizeof(T));
        need(bytes.size() == sizeof(T), "pickle", "damaged");
        std::memcpy(static_cast<void*>(&value), bytes.data(), sizeof(T));
    }
}

template <class F>
void each_part(Ground& o, F& f) {
    f(o.unit, o.width, o.height, o.north, o.north_up, o.equator_radius, o.pole_radius, o.height_metres,
      o.has_height_unit);
}

template <class F>
void each_part(Image& o, F& f) {
    f(o.planes, o.names, o.sample, o.bits, o.normal_encoding, o.normal_mark, o.no_data, o.stored, o.scale, o.offset,
      o.remark, o.ground, o.ground_remark);
}

template <class F>
void each_part(HeightField& o, F& f) {
    f(o.height, o.bumpiness_x, o.bumpiness_y, o.wrap_x, o.wrap_y, o.ground);
}

template <class F>
void each_part(Level& o, F& f) {
    f(o.extent, o.bytes);
}

template <class F>
void each_part(Texture& o, F& f) {
    f(o.format, o.levels, o.swizzle, o.swizzle_known, o.order_open, o.y_axis, o.y_known, o.x_in_grey, o.normal_encoding,
      o.srgb, o.zlib, o.bumpiness_x, o.bumpiness_y, o.orientation, o.turned, o.trailing_bytes, o.remarks);
}

template <class F>
void each_part(MeshPart& o, F& f) {
    f(o.name, o.mesh, o.primitive, o.material, o.v_axis, o.positions, o.normals, o.tangents, o.uvs, o.indices, o.quads,
      o.variants, o.colors);
}

template <class F>
void each_part(MeshMaterial& o, F& f) {
    f(o.name, o.normal_map, o.uv_set, o.has_normal_map, o.uv_transform, o.mixed_transforms, o.alpha_mode,
      o.alpha_cutoff, o.alpha);
}

template <class F>
void each_part(MeshNode& o, F& f) {
    f(o.name, o.mesh, o.to_scene);
}

template <class F>
void each_part(Mesh& o, F& f) {
    f(o.parts, o.materials, o.nodes, o.remarks);
}

template <class F>
void each_part(SelectedPiece& o, F& f) {
    f(o.name, o.material, o.triangle);
}

template <class F>
void each_part(SelectedPart& o, F& f) {
    f(o.part, o.tangents, o.source, o.has_normal_map, o.has_tangents, o.has_transform, o.rest, o.pieces, o.remarks);
}

template <class F>
void each_part(Marks& o, F& f) {
    f(o.extent, o.side, o.squares, o.texels);
}

// A rule is its id, and a unit a word of the rule table's kind: both outlive the findings.
template <class F>
void each_part(Finding& o, F& f) {
    std::string id = o.rule != nullptr ? std::string(o.rule->id) : "", unit(o.unit);
    f(id, unit);
    if constexpr (std::is_same_v<F, Loader>) {
        o.rule = find_rule(id);
        need(o.rule != nullptr, "pickle", "there is no rule " + id);
        o.unit = kept_text(unit);
    }
    f(o.severity, o.message, o.figure, o.confidence, o.regions, o.has_texel, o.column, o.row, o.fix_harms, o.marks,
      o.tone, o.tones, o.turned_y);
}

template <class F>
void each_part(CheckReport& o, F& f) {
    f(o.file, o.map, o.material, o.findings, o.explained, o.format, o.swizzle, o.kind, o.kind_confidence,
      o.height_bytes, o.extent, o.levels, o.more_data, o.y, o.pair, o.occlusion, o.seams, o.y_on_mesh);
}

template <class T>
py::tuple saved_parts(const T& value) {
    return Saver::saved(value);
}

template <class T>
T loaded_parts(const py::object& parts) {
    T value;
    Loader::load(parts, value);
    return value;
}

}  // namespace tex::python
