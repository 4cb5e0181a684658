// SPDX-License-Identifier: Apache-2.0
// verb.h: registers functions with the signature, the docstring and the stub that follow from the option structures.
//
//     verb<BakeOptions, Running>("bake", {{"height", "Heights"}}, "Normals", "Notes for Python.",
//                                [](Call& call, BakeOptions& options, Running& running) -> py::object { ... });
//
// makes bake(height, *, kernel='central', gaussian_sigma=1.0, threads=0, progress=None). Positional arguments may be
// given by their names, too. The docstring is the signature, the notes and the comment in the header.

#pragma once

#include <concepts>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <tuple>
#include <type_traits>
#include <typeinfo>
#include <utility>
#include <vector>

#include "arguments.h"
#include "errors.h"
#include "fields.h"

namespace tex::python {

// A parameter as the signature shows it.
struct Parameter {
    std::string name;
    std::string type;         // as Python source
    std::string preset = {};  // as Python source; empty: must be given
};

// Reads fields from keywords and takes those that it has read out of the dict.
class Reader {
public:
    // Some keywords may be names of arguments that are read elsewhere.
    explicit Reader(py::dict keywords, const std::vector<Parameter>& others = {}) : keywords_(std::move(keywords)) {
        for (const Parameter& other : others) names_.push_back(other.name);
    }
    // Reads the dict that is the argument called `name`.
    Reader(py::dict keywords, const char* name) : keywords_(std::move(keywords)), of_(std::string(name) + ": ") {}

    template <class T>
    void operator()(const char* name, T& field, const char* = nullptr) {
        if (has(name)) read(name, take(name), field);
    }
    template <class T, class E, std::size_t N>
    void operator()(const char* name, T&& field, const Named<E> (&)[N]) {
        (*this)(name, std::forward<T>(field));
    }
    template <class T>
    void operator()(const char* name, T& field, const Range& range) {
        (*this)(name, field);
        need_in(range, name, field);
    }
    template <class T>
    void operator()(const char* name, Axes<T> field, const Range& range) {
        (*this)(name, field);
        need_in(range, name, field.x);
        need_in(range, name, field.y);
    }
    template <class T>
    void operator()(const char* name, Axes<T> field, const char* = nullptr) {
        if (!has(name)) return;
        const py::object given = take(name);
        if (py::isinstance<py::tuple>(given) || py::isinstance<py::list>(given)) {
            const std::vector<py::object> items = items_from(given, name, 2, "a value or a pair (x, y)");
            field.x = Convert<T>::from(items[0], name);
            field.y = Convert<T>::from(items[1], name);
        } else {
            field.x = field.y = Convert<T>::from(given, name);
        }
    }

    // Raises TypeError if keywords are left.
    void finish(const std::string& function) const;

private:
    template <class T>
    static void read(const char* name, const py::object& given, T& field);
    // Raises BadOptionError for a number out of range, as the verb would.
    template <class T>
    void need_in(const Range& range, const char* name, const T& value) const {
        if (!contains(range, value)) raise({ErrorCode::bad_option, {}, of_ + name + ": " + requirement(range)});
    }
    template <class T>
    void need_in(const Range& range, const char* name, const std::optional<T>& value) const {
        if (value) need_in(range, name, *value);
    }
    py::object take(const char* name);
    bool has(const char* name) {
        names_.emplace_back(name);
        return keywords_.contains(name);
    }

    py::dict keywords_;
    std::vector<std::string> names_;  // that fields have
    std::string of_;                  // "camera: "
};

// A structure whose fields each_field() lists.
template <class T>
concept Fielded = requires(T& options, Reader& reader) {
    each_field(options, reader);
};

template <class T>
struct IsOptional : std::false_type {};
template <class T>
struct IsOptional<std::optional<T>> : std::bool_constant<Fielded<T>> {};

template <Fielded T>
T fields_from(py::handle given, const char* name) {
    if (!py::isinstance<py::dict>(given)) raise_type(name, "a dict of its fields", given);
    T options;
    Reader reader(py::reinterpret_steal<py::dict>(PyDict_Copy(given.ptr())), name);
    each_field(options, reader);
    reader.finish(name);
    return options;
}

template <class T>
void Reader::read(const char* name, const py::object& given, T& field) {
    if constexpr (Fielded<T>) {
        field = fields_from<T>(given, name);
    } else if constexpr (IsOptional<T>::value) {
        field.reset();
        if (!given.is_none()) field = fields_from<typename T::value_type>(given, name);
    } else {
        field = Convert<T>::from(given, name);
    }
}

// Lists fields as parameters.
class Lister {
public:
    template <class T>
    void operator()(const char* name, T& field, const char* type = nullptr) {
        if constexpr (Fielded<T>) {
            list(name, type, dict_type<T>(), "{}");
        } else if constexpr (IsOptional<T>::value) {
            list(name, type, dict_type<typename T::value_type>() + " | None", "None");
        } else {
            list(name, type, Convert<T>::type(), Convert<T>::shown(field));
        }
    }
    template <class T, class E, std::size_t N>
    void operator()(const char* name, T&& field, const Named<E> (&)[N]) {
        (*this)(name, std::forward<T>(field));
    }
    template <class T>
    void operator()(const char* name, T&& field, const Range&) {
        (*this)(name, std::forward<T>(field));
    }
    template <class T>
    void operator()(const char* name, Axes<T> field, const char* type = nullptr) {
        const std::string one = Convert<T>::type();
        list(name, type, one + " | tuple[" + one + ", " + one + "]", Convert<T>::shown(field.x));
    }

    std::vector<Parameter> parameters;

private:
    // The name of a TypedDict of the fields of T. The stubs define it.
    template <class T>
    static std::string dict_type() {
        T fields;
        Lister inner;
        each_field(fields, inner);
        return define_dict(typeid(T), inner.parameters);
    }
    static std::string define_dict(const std::type_info& type, const std::vector<Parameter>& fields);

    void list(const char* name, const char* type, const std::string& usual, const std::string& preset) {
        parameters.push_back({name, type != nullptr ? type : usual, preset});
    }
};

// The positional arguments of one call.
class Call {
public:
    // `positional`: how many may be given without their names.
    Call(const char* function, const std::vector<Parameter>& parameters, const py::args& given,
         const py::dict& keywords, std::size_t positional);

    // The argument called `name`; None if it has a preset and was not given.
    [[nodiscard]] py::object operator[](std::string_view name) const;
    [[nodiscard]] bool has(std::string_view name) const { return !(*this)[name].is_none(); }

private:
    const std::vector<Parameter>& parameters_;
    std::vector<py::object> values_;
};

// The module, its verbs and its stubs.
class Module {
public:
    explicit Module(py::module_& module) : module_(module) {}

    template <class... Options, class Body>
    void verb(const char* name, std::vector<Parameter> positional, const char* returns, const std::string& notes,
              Body body) {
        Lister lister;
        [[maybe_unused]] const auto list = [&lister](auto options) { each_field(options, lister); };
        (list(Options{}), ...);
        const std::string doc = describe(name, positional, lister.parameters, returns, notes);
        overloads_.clear();
        const auto invoke = [name, positional = std::move(positional), body = std::move(body)](
                                const py::args& given, const py::kwargs& keywords) -> py::object {
            const py::dict left = py::reinterpret_steal<py::dict>(PyDict_Copy(keywords.ptr()));
            Call call(name, positional, given, left, positional.size());
            Reader reader(left, positional);
            std::tuple<Options...> options;
            std::apply([&reader](auto&... each) { (each_field(each, reader), ...); }, options);
            reader.finish(std::string(name) + "()");
            return std::apply([&](auto&... each) -> py::object { return body(call, each...); }, options);
        };
        define(name, invoke, doc);
    }

    // The return type of the next verb depends on its first argument: pairs of types, as the stubs show them.
    void overload(std::vector<std::pair<std::string, std::string>> types) { overloads_ = std::move(types); }

    // Adds `text`, a declaration, to the stubs.
    void stub(const std::string& text);
    // "(self, a: int, *, b: int = 3)"
    static std::string signature(const std::string& first, const std::vector<Parameter>& positional,
                                 const std::vector<Parameter>& keywords);
    [[nodiscard]] py::module_& module() { return module_; }

private:
    // Adds a builtin function. Unlike those of pybind11, it belongs to the module, so pickle knows it by its name.
    using Function = std::function<py::object(const py::args&, const py::kwargs&)>;
    void define(const char* name, Function function, const std::string& doc);

    // Adds the function's stub. Returns its docstring, which begins with the signature for inspect.signature().
    std::string describe(const char* name, const std::vector<Parameter>& positional,
                         const std::vector<Parameter>& keywords, const char* returns, const std::string& notes);

    py::module_& module_;
    std::vector<std::pair<std::string, std::string>> overloads_;
};

// What pickling.h makes of an object and back.
template <class T>
py::tuple saved_parts(const T& value);
template <class T>
T loaded_parts(const py::object& parts);

// A class whose attributes are read-only, with its stub: call finish() last. There are no objects without a value:
// __new__() makes whole ones, or raises TypeError.
template <class T>
class Class {
public:
    Class(Module& module, const char* name, const char* doc)
        : module_(module), name_(name), class_(module.module(), name, doc, py::is_final()),
          stub_(std::string("@final\nclass ") + name + ":\n    \"\"\"" + doc + "\"\"\"\n") {
        made_by([name](const py::args&, const py::kwargs&) -> py::object {
            throw py::type_error(std::string("tex.") + name + " has no constructor");
        });
        class_.attr("__init__") =
            py::cpp_function([](const py::object&, const py::args&, const py::kwargs&) {}, py::is_method(class_));
    }

    template <class Get>
    Class& property(const char* name, const char* type, const char* doc, Get get) {
        class_.def_property_readonly(name, std::move(get), doc);
        stub_ += std::string("    @property\n    def ") + name + "(self) -> " + type + ":\n        \"\"\"" + doc +
                 "\"\"\"\n";
        return *this;
    }
    // A method; `signature` is what follows the name in the stub: "(self) -> int".
    template <class Body, class... More>
    Class& method(const char* name, const char* signature, Body body, More&&... more) {
        class_.def(name, std::move(body), std::forward<More>(more)...);
        stub_ += std::string("    def ") + name + signature + ": ...\n";
        return *this;
    }
    // A constructor: make(call) returns a T. `positional` of the parameters may be given without their names.
    template <class Make>
    Class& constructor(std::vector<Parameter> parameters, std::size_t positional, Make make) {
        const auto split = parameters.begin() + static_cast<std::ptrdiff_t>(positional);
        stub_ += "    def __init__" +
                 Module::signature("self", {parameters.begin(), split}, {split, parameters.end()}) + " -> None: ...\n";
        made_by([name = name_, parameters = std::move(parameters), positional, make = std::move(make)](
                    const py::args& given, const py::kwargs& keywords) -> py::object {
            const py::dict left = py::reinterpret_steal<py::dict>(PyDict_Copy(keywords.ptr()));
            Call call(name, parameters, given, left, positional);
            Reader(left, parameters).finish(std::string(name) + "()");
            return py::cast(std::make_shared<T>(make(call)));
        });
        return *this;
    }
    // Lets pickle and copy make copies.
    Class& copies() {
        const std::string restore = std::string("_restore_") + name_;
        module_.module().def(restore.c_str(),
                             [](const py::object& parts) { return std::make_shared<T>(loaded_parts<T>(parts)); });
        class_.def("__reduce__", [name = name_](const T& self) {
            return py::make_tuple(py::module_::import("tex._pickling").attr("restore"),
                                  py::make_tuple(name, saved_parts(self)));
        });
        return *this;
    }
    // Adds the stub, which is complete now.
    void finish() { module_.stub(stub_); }

private:
    template <class Make>
    void made_by(Make make) {
        class_.attr("__new__") = py::staticmethod(
            py::cpp_function([make = std::move(make)](const py::object&, const py::args& given,
                                                      const py::kwargs& keywords) { return make(given, keywords); }));
    }

    Module& module_;
    const char* name_;
    py::class_<T, std::shared_ptr<T>> class_;
    std::string stub_;
};

}  // namespace tex::python
