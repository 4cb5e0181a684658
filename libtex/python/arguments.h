// SPDX-License-Identifier: Apache-2.0
// arguments.h: Python values to C++ values and back: one Convert<T> for each type of option.
//
// Enumerators are the words of their name tables. A wrong type raises TypeError and a wrong value ValueError, with the
// name of the argument and what it may be.

#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include <pybind11/pybind11.h>
#include <tex/tex.h>

namespace tex::python {

namespace py = pybind11;

// name: expected `wanted`, got the type of `given`.
[[noreturn]] void raise_type(std::string_view name, std::string_view wanted, py::handle given);
[[noreturn]] void raise_value(std::string_view name, std::string_view reason);
// Raises ValueError unless `sound`.
inline void need(bool sound, std::string_view name, std::string_view reason) {
    if (!sound) raise_value(name, reason);
}

double number_from(py::handle given, std::string_view name);
std::int64_t integer_from(py::handle given, std::string_view name, std::int64_t least, std::int64_t most);
std::string text_from(py::handle given, std::string_view name);
// A str or a path (os.PathLike).
std::string path_from(py::handle given, std::string_view name);
bool is_path(py::handle given);
// A text of libtex as str. Its bytes need not be UTF-8: as Python reads names of files.
py::str str_of(std::string_view text);
py::list strs_of(const std::vector<std::string>& texts);
// Whether it is (chain, info) of read_normals(), which many pass on as if it were the chain.
[[nodiscard]] bool is_source(py::handle given);

// "; did you mean 'x'?" if one of `names` is like `name`, or empty.
std::string did_you_mean(const std::string& name, const std::vector<std::string>& names);
// A copy of the text, which is never freed.
std::string_view kept_text(const std::string& text);
// "BC5_SNORM" as "bc5-snorm"
std::string plain_word(std::string word);
// Exactly `count` items of a sequence that is not a str.
std::vector<py::object> items_from(py::handle given, std::string_view name, std::size_t count, std::string_view wanted);
std::string shown_float(float value);
std::string shown_text(std::string_view text);  // in quotes

// The name table of an enum.
template <class E>
struct Words;
#define TEX_PYTHON_WORDS(Enum)                               \
    template <>                                              \
    struct Words<Enum> {                                     \
        static constexpr const auto& kRows = k##Enum##Names; \
    }
TEX_PYTHON_WORDS(BlendMode);
TEX_PYTHON_WORDS(Component);
TEX_PYTHON_WORDS(Container);
TEX_PYTHON_WORDS(CurvatureKind);
TEX_PYTHON_WORDS(DdsHeader);
TEX_PYTHON_WORDS(Deband);
TEX_PYTHON_WORDS(Decoder);
TEX_PYTHON_WORDS(DecoderKind);
TEX_PYTHON_WORDS(Effort);
TEX_PYTHON_WORDS(Encoding);
TEX_PYTHON_WORDS(ErrorCode);
TEX_PYTHON_WORDS(FileValues);
TEX_PYTHON_WORDS(Format);
TEX_PYTHON_WORDS(GpuFormat);
TEX_PYTHON_WORDS(GradientKernel);
TEX_PYTHON_WORDS(GroundUnit);
TEX_PYTHON_WORDS(HeightChannel);
TEX_PYTHON_WORDS(LightKind);
TEX_PYTHON_WORDS(Metric);
TEX_PYTHON_WORDS(MirroredChannel);
TEX_PYTHON_WORDS(TurnedPicture);
TEX_PYTHON_WORDS(MipDomain);
TEX_PYTHON_WORDS(MipFilter);
TEX_PYTHON_WORDS(ExtraKind);
TEX_PYTHON_WORDS(RepairClass);
TEX_PYTHON_WORDS(RepairKind);
TEX_PYTHON_WORDS(RoughnessModel);
TEX_PYTHON_WORDS(RuleFamily);
TEX_PYTHON_WORDS(ScaleMode);
TEX_PYTHON_WORDS(Severity);
TEX_PYTHON_WORDS(Shape);
TEX_PYTHON_WORDS(Show);
TEX_PYTHON_WORDS(SpecularModel);
TEX_PYTHON_WORDS(TangentMethod);
TEX_PYTHON_WORDS(TangentSource);
TEX_PYTHON_WORDS(ValueRange);
TEX_PYTHON_WORDS(Wrap);
TEX_PYTHON_WORDS(YAxis);
#undef TEX_PYTHON_WORDS

template <>
struct Words<SampleKind> {  // has no table, because no user chooses it
    static constexpr Named<SampleKind> kRows[] = {
        {SampleKind::unorm, "unorm", ""}, {SampleKind::snorm, "snorm", ""}, {SampleKind::floating, "float", ""}};
};

template <class E>
concept Worded = requires {
    Words<E>::kRows;
};

template <Worded E>
py::str word_of(E value) {
    return std::string(name_of(Words<E>::kRows, value));
}

// from(): the C++ value of `given`. shown(): a value as Python source. type(): the type as Python source.
template <class T>
struct Convert;

template <>
struct Convert<bool> {
    static bool from(py::handle given, std::string_view name) {
        if (!py::isinstance<py::bool_>(given)) raise_type(name, "bool", given);
        return given.ptr() == Py_True;
    }
    static std::string shown(bool value) { return value ? "True" : "False"; }
    static std::string type() { return "bool"; }
};

template <class T>
requires(std::is_integral_v<T> && !std::is_same_v<T, bool>) struct Convert<T> {
    static T from(py::handle given, std::string_view name) {
        return static_cast<T>(integer_from(given, name, std::numeric_limits<T>::min(), std::numeric_limits<T>::max()));
    }
    static std::string shown(T value) { return std::to_string(value); }
    static std::string type() { return "int"; }
};

template <>
struct Convert<float> {
    static float from(py::handle given, std::string_view name) { return static_cast<float>(number_from(given, name)); }
    static std::string shown(float value) { return shown_float(value); }
    static std::string type() { return "float"; }
};

template <>
struct Convert<double> {
    static double from(py::handle given, std::string_view name) { return number_from(given, name); }
    static std::string shown(double value) { return shown_float(static_cast<float>(value)); }
    static std::string type() { return "float"; }
};

template <>
struct Convert<std::string> {  // texts of options are paths or names
    static std::string from(py::handle given, std::string_view name) { return path_from(given, name); }
    static std::string shown(const std::string& value) { return shown_text(value); }
    static std::string type() { return "str"; }
};

template <Worded E>
struct Convert<E> {
    static E from(py::handle given, std::string_view name) {
        if (!py::isinstance<py::str>(given)) raise_type(name, "one of the words " + words(), given);
        const std::string word = text_from(given, name);
        if (const std::optional<E> found = find_by_name(Words<E>::kRows, word)) return *found;
        if (const std::optional<E> found = find_by_name(Words<E>::kRows, plain_word(word))) return *found;
        raise_value(name, shown_text(word) + " must be one of " + words());
    }
    static std::string shown(E value) { return shown_text(name_of(Words<E>::kRows, value)); }
    static std::string type() { return "Literal[" + words() + "]"; }
    static std::string words() {
        std::string all;
        for (const Named<E>& row : Words<E>::kRows) all += (all.empty() ? "" : ", ") + shown_text(row.name);
        return all;
    }
};

template <class T>
struct Convert<std::optional<T>> {
    static std::optional<T> from(py::handle given, std::string_view name) {
        if (given.is_none()) return std::nullopt;
        return Convert<T>::from(given, name);
    }
    static std::string shown(const std::optional<T>& value) { return value ? Convert<T>::shown(*value) : "None"; }
    static std::string type() { return Convert<T>::type() + " | None"; }
};

// Any object, which the verb converts.
template <>
struct Convert<py::object> {
    static py::object from(py::handle given, std::string_view) { return py::reinterpret_borrow<py::object>(given); }
    static std::string shown(const py::object& value) { return py::repr(value); }
    static std::string type() { return "object"; }
};

// (width, height)
template <>
struct Convert<Extent> {
    static Extent from(py::handle given, std::string_view name);
    static std::string shown(Extent value);
    static std::string type() { return "tuple[int, int]"; }
};

// (first, last)
template <>
struct Convert<Fade> {
    static Fade from(py::handle given, std::string_view name);
    static std::string shown(Fade value);
    static std::string type() { return "tuple[int, int]"; }
};

// A layout of kSwizzleNames ("dxt5nm"), or what R, G, B and A hold, as four characters ("1y1x").
template <>
struct Convert<Swizzle> {
    static Swizzle from(py::handle given, std::string_view name);
    static std::string shown(const Swizzle& value) { return shown_text(layout_name(value)); }
    static std::string type() { return "str"; }
};

// The extra channel with that name: an attribute of a tex.NormalMap, a key of a dict. Raises ValueError for others.
[[nodiscard]] Extra extra_from(std::string_view word, std::string_view name);

// The names of planes: ["alpha"]
template <>
struct Convert<ExtraSet> {
    static ExtraSet from(py::handle given, std::string_view name);
    static std::string shown(ExtraSet value);
    static std::string type() { return "Sequence[Literal['blue', 'alpha', 'length']]"; }
};

// (r, g, b)
template <>
struct Convert<Rgb> {
    static Rgb from(py::handle given, std::string_view name);
    static std::string shown(Rgb value);
    static std::string type() { return "tuple[float, float, float]"; }
};

py::tuple tuple_of(Extent extent);

}  // namespace tex::python
