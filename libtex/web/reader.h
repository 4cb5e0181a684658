// SPDX-License-Identifier: Apache-2.0
// reader.h: options as JSON, read by the tables of fields that the commands and Python have (libtex/src/fields), and
// listed as TypeScript.

#pragma once

#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <tex/tex.h>

#include "fields/bake_fields.h"
#include "fields/blend_fields.h"
#include "fields/height_fields.h"
#include "fields/mip_fields.h"
#include "fields/pack_fields.h"
#include "json.h"

namespace tex::web {

// What a call throws, and nothing else: it becomes an exception of JavaScript.
struct Failure {
    Error error;
};
[[noreturn]] void fail(const std::string& reason, ErrorCode code = ErrorCode::bad_option);
const std::string& text_from(const Json& given, const std::string& name);
const std::vector<Json>& list_from(const Json& given, const std::string& name);
// A layout's name ("dxt5nm"), or what R, G, B and A hold ("1y1x").
Swizzle swizzle_from(const Json& given, const std::string& name);

template <class T>
struct IsOptional : std::false_type {};
template <class T>
struct IsOptional<std::optional<T>> : std::true_type {};

// Reads the fields that an object has; finish() refuses those that nobody has asked for.
class Reader {
public:
    explicit Reader(const Json& options) : options_(options) {
        if (!options.is_object()) fail("options: expected an object");
    }

    template <class T>
    void operator()(const char* name, T& field) {
        if (const Json* const given = find(name)) read(name, *given, field);
    }
    template <class T>
    void operator()(const char* name, T& field, const Range& range) {
        (*this)(name, field);
        need_in(range, name, field);
    }
    template <class T, class E, std::size_t N>
    void operator()(const char* name, T& field, const Named<E> (&words)[N]) {
        if (const Json* const given = find(name)) field = word(name, *given, words);
    }
    template <class T, class... Rest>
    void operator()(const char* name, Axes<T> field, const Rest&... rest) {
        const Json* const given = find(name);
        if (given == nullptr) return;
        const std::vector<Json>& both = given->elements();
        const bool pair = given->is_list() && both.size() == 2;
        if (given->is_list() && !pair) fail(std::string(name) + ": expected a value or a pair [x, y]");
        one(name, pair ? both[0] : *given, field.x, rest...);
        one(name, pair ? both[1] : *given, field.y, rest...);
    }
    // A member that is no field.
    void leave(const char* name) { names_.emplace_back(name); }
    void finish() const;

private:
    const Json* find(const char* name) {
        leave(name);
        return options_.find(name);
    }
    template <class E, std::size_t N>
    static E word(const char* name, const Json& given, const Named<E> (&words)[N]) {
        if (given.is_string()) {
            if (const auto found = find_by_name(words, given.text())) return *found;
        }
        std::string all;
        for (const Named<E>& row : words) all += (all.empty() ? "'" : ", '") + std::string(row.name) + "'";
        fail(std::string(name) + ": must be one of " + all);
    }
    template <class T, class E, std::size_t N>
    static void one(const char* name, const Json& given, T& field, const Named<E> (&words)[N]) {
        field = word(name, given, words);
    }
    template <class T>
    static void one(const char* name, const Json& given, T& field, const Range& range) {
        read(name, given, field);
        need_in(range, name, field);
    }
    // Refuses a number out of range, as the verb would, also where the verb does not read it.
    template <class T>
    static void need_in(const Range& range, const char* name, const T& value) {
        if (!contains(range, value)) fail(std::string(name) + ": " + requirement(range));
    }
    template <class T>
    static void one(const char* name, const Json& given, T& field) {
        read(name, given, field);
    }
    template <class T>
    static void read(const char* name, const Json& given, T& field);
    static double number(const char* name, const Json& given);
    static int integer(const char* name, const Json& given);

    const Json& options_;
    std::vector<std::string> names_;
};

template <class T>
void Reader::read(const char* name, const Json& given, T& field) {
    if constexpr (IsOptional<T>::value) {
        field.reset();
        if (!given.is_null()) read(name, given, field.emplace());
    } else if constexpr (std::is_same_v<T, bool>) {
        if (!given.is_boolean()) fail(std::string(name) + ": expected true or false");
        field = given.boolean();
    } else if constexpr (std::is_floating_point_v<T>) {
        field = static_cast<T>(number(name, given));
    } else if constexpr (std::is_integral_v<T>) {
        field = static_cast<T>(integer(name, given));
    } else if constexpr (std::is_same_v<T, std::string>) {
        field = text_from(given, name);
    } else if constexpr (std::is_same_v<T, Swizzle>) {
        field = swizzle_from(given, name);
    } else if constexpr (std::is_same_v<T, YAxis>) {
        field = word(name, given, kYAxisNames);
    } else {  // two integers: Extent, Fade
        if (!given.is_list() || given.elements().size() != 2) fail(std::string(name) + ": expected a pair of integers");
        auto& [first, second] = field;
        first = integer(name, given.elements()[0]);
        second = integer(name, given.elements()[1]);
    }
}

// PackOptions and others as Python has them: RDO's fields are beside the rest.
struct PackKeywords : PackOptions {};
template <class F>
void each_field(PackKeywords& o, F& f) {
    f("encoding", o.encoding, kEncodingNames);
    f("y_axis", o.y_axis, kYAxisNames);
    f("effort", o.effort, kEffortNames);
    f("metric", o.metric, kMetricNames);
    f("y_known", o.y_known);
    f("rdo_mean", o.rdo.mean, kDegrees);
    f("rdo_max", o.rdo.max, kDegrees);
    f("rdo_window", o.rdo.window, Range{kLeastRdoWindow, kMostRdoWindow});
}

struct UnpackKeywords : UnpackOptions {};
template <class F>
void each_field(UnpackKeywords& o, F& f) {
    f("swizzle", o.swizzle);
    f("y_axis", o.y_axis);
    f("range", o.range, kValueRangeNames);
    f("snap_flat", o.snap_flat);
    f("keep_length", o.keep_length);
    f("keep_invalid", o.keep_invalid);
}

struct MipKeywords : MipOptions {};
template <class F>
void each_field(MipKeywords& o, F& f) {
    level_fields(o, f);
}

// A height field's own, and those of its slopes.
struct BakeKeywords : BakeOptions {
    float bumpiness_x = 1.0f, bumpiness_y = 1.0f;
    Wrap wrap_x = Wrap::repeat, wrap_y = Wrap::repeat;
};
template <class F>
void each_field(BakeKeywords& o, F& f) {
    f("kernel", o.kernel, kGradientKernelNames);
    f("gaussian_sigma", o.gaussian_sigma, Range{0.0, kMaxGaussianSigma, false});
    f("bumpiness", axes(o.bumpiness_x, o.bumpiness_y), Range{});
    f("wrap", axes(o.wrap_x, o.wrap_y), kWrapNames);
}

struct EncodeKeywords : WriteOptions {
    Container container = Container::dds;
};
template <class F>
void each_field(EncodeKeywords& o, F& f) {
    f("container", o.container, kContainerNames);
    f("dds_header", o.dds_header, kDdsHeaderNames);
    f("dds_mark", o.dds_mark);
    f("zstd", o.zstd, Range{0, kHighestZstdLevel});
}

// Lists fields as the members of a TypeScript interface.
class Lister {
public:
    template <class T>
    void operator()(const char* name, T& field) {
        add(name, type<T>(), shown(field), {});
    }
    template <class T>
    void operator()(const char* name, T& field, const Range& range) {
        add(name, type<T>(), shown(field), requirement(range));
    }
    template <class T, class E, std::size_t N>
    void operator()(const char* name, T& field, const Named<E> (&words)[N]) {
        add(name, union_of(words), "'" + std::string(name_of(words, field)) + "'", {});
    }
    template <class T>
    void operator()(const char* name, Axes<T> field) {
        add(name, pair_of(type<T>()), shown(field.x), {});
    }
    template <class T>
    void operator()(const char* name, Axes<T> field, const Range& range) {
        add(name, pair_of(type<T>()), shown(field.x), requirement(range));
    }
    template <class T, class E, std::size_t N>
    void operator()(const char* name, Axes<T> field, const Named<E> (&words)[N]) {
        add(name, pair_of(union_of(words)), "'" + std::string(name_of(words, field.x)) + "'", {});
    }

    std::string members;

private:
    template <class T>
    static std::string type() {
        if constexpr (IsOptional<T>::value) return type<typename T::value_type>() + " | null";
        if constexpr (std::is_same_v<T, bool>) return "boolean";
        if constexpr (std::is_arithmetic_v<T>) return "number";
        if constexpr (std::is_same_v<T, YAxis>) return union_of(kYAxisNames);
        if constexpr (std::is_same_v<T, Extent> || std::is_same_v<T, Fade>) return "[number, number]";
        return "string";
    }
    template <class E, std::size_t N>
    static std::string union_of(const Named<E> (&words)[N]) {
        std::string all;
        for (const Named<E>& row : words) all += (all.empty() ? "'" : " | '") + std::string(row.name) + "'";
        return all;
    }
    static std::string pair_of(const std::string& one) { return one + " | [" + one + ", " + one + "]"; }
    template <class T>
    static std::string shown(const T& value) {
        if constexpr (std::is_same_v<T, bool>) return value ? "true" : "false";
        if constexpr (std::is_floating_point_v<T>) return rounded_text(static_cast<double>(value), 9);
        if constexpr (std::is_integral_v<T>) return std::to_string(value);
        return {};
    }
    void add(const char* name, const std::string& type, const std::string& preset, const std::string& must);
};

}  // namespace tex::web
