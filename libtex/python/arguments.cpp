// SPDX-License-Identifier: Apache-2.0
#include "arguments.h"

#include <algorithm>
#include <charconv>
#include <iterator>
#include <limits>
#include <set>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <pybind11/numpy.h>

namespace tex::python {
namespace {

// Whether numpy's scalars and other numbers count: whatever has __float__ or __index__, but no bool.
bool is_real(py::handle given) {
    return !py::isinstance<py::bool_>(given) && !py::isinstance<py::str>(given) && PyNumber_Check(given.ptr()) != 0;
}

}  // namespace

void raise_type(std::string_view name, std::string_view wanted, py::handle given) {
    const char* const hint = is_source(given) ? ", as read_normals() returns it: (chain, info)" : "";
    throw py::type_error(fmt::format("{}: expected {}, got {}{}", name, wanted, Py_TYPE(given.ptr())->tp_name, hint));
}

bool is_source(py::handle given) {
    if (!py::isinstance<py::tuple>(given) || py::len(given) != 2) return false;
    const auto pair = py::reinterpret_borrow<py::tuple>(given);
    return py::isinstance<py::list>(pair[0]) && !py::isinstance<py::list>(pair[1]) &&
           !py::isinstance<py::array>(pair[1]);
}

void raise_value(std::string_view name, std::string_view reason) {
    throw py::value_error(fmt::format("{}: {}", name, reason));
}

double number_from(py::handle given, std::string_view name) {
    if (!is_real(given)) raise_type(name, "a number", given);
    const double number = PyFloat_AsDouble(given.ptr());
    if (number == -1.0 && PyErr_Occurred() != nullptr) {
        PyErr_Clear();
        raise_type(name, "a number", given);
    }
    return number;
}

std::int64_t integer_from(py::handle given, std::string_view name, std::int64_t least, std::int64_t most) {
    if (!is_real(given) || PyIndex_Check(given.ptr()) == 0) raise_type(name, "int", given);
    const auto whole = py::reinterpret_steal<py::object>(PyNumber_Index(given.ptr()));
    if (!whole) throw py::error_already_set();
    int overflow = 0;
    const long long number = PyLong_AsLongLongAndOverflow(whole.ptr(), &overflow);
    if (overflow != 0 || number < least || number > most)
        raise_value(name, fmt::format("{} must be from {} to {}", std::string(py::str(given)), least, most));
    return number;
}

std::string text_from(py::handle given, std::string_view name) {
    if (!py::isinstance<py::str>(given)) raise_type(name, "str", given);
    const auto bytes = py::reinterpret_steal<py::bytes>(PyUnicode_EncodeFSDefault(given.ptr()));
    if (!bytes) throw py::error_already_set();
    return bytes;
}

bool is_path(py::handle given) {
    return py::isinstance<py::str>(given) || py::isinstance<py::bytes>(given) || py::hasattr(given, "__fspath__");
}

py::str str_of(std::string_view text) {
    const auto made = py::reinterpret_steal<py::str>(
        PyUnicode_DecodeFSDefaultAndSize(text.data(), static_cast<Py_ssize_t>(text.size())));
    if (!made) throw py::error_already_set();
    return made;
}

py::list strs_of(const std::vector<std::string>& texts) {
    py::list list;
    for (const std::string& text : texts) list.append(str_of(text));
    return list;
}

std::string did_you_mean(const std::string& name, const std::vector<std::string>& names) {
    // What the commands call an argument, or other tools.
    constexpr std::pair<std::string_view, std::string_view> kElsewhere[] = {
        {"format", "encoding"}, {"size", "extent"}, {"strength", "bumpiness"}, {"y_out", "y"}};
    for (const auto& [word, ours] : kElsewhere) {
        if (name == word && std::find(names.begin(), names.end(), ours) != names.end())
            return fmt::format("; did you mean '{}'?", ours);
    }
    py::list all;
    for (const std::string& each : names) all.append(str_of(each));
    const py::list close = py::module_::import("difflib").attr("get_close_matches")(str_of(name), all, 1);
    return close.empty() ? "" : fmt::format("; did you mean '{}'?", std::string(py::str(close[0])));
}

std::string_view kept_text(const std::string& text) {
    static auto* const texts = new std::set<std::string>;
    return *texts->insert(text).first;
}

std::string plain_word(std::string word) {
    for (char& c : word) {
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
        if (c == '_') c = '-';
    }
    return word;
}

std::string path_from(py::handle given, std::string_view name) {
    PyObject* bytes = nullptr;
    if (PyUnicode_FSConverter(given.ptr(), &bytes) == 0) {
        if (PyErr_ExceptionMatches(PyExc_TypeError) == 0) throw py::error_already_set();  // a NUL inside: ValueError
        PyErr_Clear();
        raise_type(name, "str or os.PathLike", given);
    }
    return py::reinterpret_steal<py::bytes>(bytes);
}

std::vector<py::object> items_from(py::handle given, std::string_view name, std::size_t count,
                                   std::string_view wanted) {
    if (py::isinstance<py::str>(given) || PySequence_Check(given.ptr()) == 0) raise_type(name, wanted, given);
    const auto sequence = py::reinterpret_borrow<py::sequence>(given);
    if (sequence.size() != count) raise_value(name, fmt::format("expected {}", wanted));
    std::vector<py::object> items;
    for (std::size_t k = 0; k < count; ++k) items.push_back(sequence[k]);
    return items;
}

std::string shown_float(float value) {
    char text[32];
    const auto end = std::to_chars(text, text + sizeof text, value).ptr;
    std::string shown(text, end);
    if (shown.find_first_of(".en") == std::string::npos) shown += ".0";
    return shown;
}

std::string shown_text(std::string_view text) { return fmt::format("'{}'", text); }

Extent Convert<Extent>::from(py::handle given, std::string_view name) {
    const std::vector<py::object> items = items_from(given, name, 2, "a pair (width, height)");
    const auto side = [&](std::size_t k) { return static_cast<int>(integer_from(items[k], name, 0, kMaxExtent)); };
    return {side(0), side(1)};
}

std::string Convert<Extent>::shown(Extent value) { return fmt::format("({}, {})", value.width, value.height); }

Fade Convert<Fade>::from(py::handle given, std::string_view name) {
    const std::vector<py::object> items = items_from(given, name, 2, "a pair (first, last)");
    const Fade fade{Convert<int>::from(items[0], name), Convert<int>::from(items[1], name)};
    need(fade.first >= 0 && fade.first < fade.last, name, "first must be 0 or more, and below last");
    return fade;
}

std::string Convert<Fade>::shown(Fade value) { return fmt::format("({}, {})", value.first, value.last); }

Extra extra_from(std::string_view word, std::string_view name) {
    const std::optional<Extra> extra = find_by_name(kExtraNames, word);
    need(extra.has_value(), name, shown_text(word) + " must be one of 'blue', 'alpha', 'length'");
    return *extra;
}

ExtraSet Convert<ExtraSet>::from(py::handle given, std::string_view name) {
    constexpr std::string_view kWanted = "a sequence of 'blue', 'alpha' and 'length'";
    if (!py::isinstance<py::list>(given) && !py::isinstance<py::tuple>(given)) raise_type(name, kWanted, given);
    ExtraSet planes;
    for (const py::handle item : given) planes[extra_from(text_from(item, name), name)] = true;
    return planes;
}

std::string Convert<ExtraSet>::shown(ExtraSet value) {
    std::string names;
    for (const auto& [extra, name, meaning] : kExtraNames) {
        if (value[extra]) names += (names.empty() ? "" : ", ") + shown_text(name);
    }
    return "[" + names + "]";
}

Swizzle Convert<Swizzle>::from(py::handle given, std::string_view name) {
    const std::string text = text_from(given, name);
    if (const std::optional<Swizzle> layout = find_by_name(kSwizzleNames, text)) return *layout;
    Swizzle swizzle{};
    bool sound = text.size() == swizzle.size();
    for (std::size_t c = 0; sound && c < swizzle.size(); ++c) {
        const std::optional<Component> component = find_by_name(kComponentNames, std::string_view(text).substr(c, 1));
        sound = component.has_value();
        if (sound) swizzle[c] = *component;
    }
    if (sound) return swizzle;
    std::string layouts;
    for (const Named<Swizzle>& row : kSwizzleNames) layouts += (layouts.empty() ? "" : ", ") + shown_text(row.name);
    raise_value(name,
                fmt::format("'{}' must be one of {}, or four characters of 01xyz_, for R, G, B and A", text, layouts));
}

Rgb Convert<Rgb>::from(py::handle given, std::string_view name) {
    const std::vector<py::object> items = items_from(given, name, 3, "three numbers (r, g, b)");
    const auto value = [&](std::size_t k) { return Convert<float>::from(items[k], name); };
    return {value(0), value(1), value(2)};
}

std::string Convert<Rgb>::shown(Rgb value) {
    return fmt::format("({}, {}, {})", shown_float(value.r), shown_float(value.g), shown_float(value.b));
}

py::tuple tuple_of(Extent extent) { return py::make_tuple(extent.width, extent.height); }

}  // namespace tex::python
