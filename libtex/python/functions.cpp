// SPDX-License-Identifier: Apache-2.0
// Builtin functions of the module itself.
//
// The functions of pybind11 have a capsule as __self__, and pickle fails on it. Those made here have the module, as
// functions written in C do, so that pickle stores their name. Python tells a C function nothing but its __self__,
// so each function here has a C function of its own, with the index of its row built in.

#include <array>
#include <exception>
#include <new>
#include <stdexcept>
#include <string>
#include <utility>

#include "verb.h"

namespace tex::python {
namespace {

constexpr std::size_t kMostFunctions = 160;

struct Defined {
    std::string name, doc;
    std::function<py::object(const py::args&, const py::kwargs&)> function;
    PyMethodDef method = {};
};

// They live as long as the process, as the module does.
std::array<Defined, kMostFunctions>& table() {
    static auto* const rows = new std::array<Defined, kMostFunctions>();
    return *rows;
}

// Calls function `index`. What it throws becomes Python's error.
PyObject* call(std::size_t index, PyObject* arguments, PyObject* keywords) {
    try {
        const auto args = py::reinterpret_borrow<py::args>(arguments);
        const auto named = keywords != nullptr ? py::reinterpret_borrow<py::kwargs>(keywords) : py::kwargs();
        return table()[index].function(args, named).release().ptr();
    } catch (py::error_already_set& error) {
        error.restore();
    } catch (const py::builtin_exception& error) {
        error.set_error();
    } catch (const std::bad_alloc&) {
        PyErr_NoMemory();
    } catch (const std::exception& error) {
        PyErr_SetString(PyExc_RuntimeError, error.what());
    }
    return nullptr;
}

using Entry = PyObject* (*)(PyObject*, PyObject*, PyObject*);

template <std::size_t... Index>
constexpr std::array<Entry, sizeof...(Index)> entries_of(std::index_sequence<Index...>) {
    return {[](PyObject*, PyObject* arguments, PyObject* keywords) { return call(Index, arguments, keywords); }...};
}

constexpr std::array<Entry, kMostFunctions> kEntries = entries_of(std::make_index_sequence<kMostFunctions>());

}  // namespace

void Module::define(const char* name, Function function, const std::string& doc) {
    static std::size_t count = 0;
    if (count == kMostFunctions) throw std::logic_error("kMostFunctions is too small");
    Defined& row = table()[count];
    row.name = name;
    row.doc = doc;
    row.function = std::move(function);
    // The way that the C API has for functions that take keywords.
    row.method = {row.name.c_str(), reinterpret_cast<PyCFunction>(reinterpret_cast<void (*)()>(kEntries[count])),
                  METH_VARARGS | METH_KEYWORDS, row.doc.c_str()};
    ++count;
    const py::str module_name = module_.attr("__name__");
    const auto made =
        py::reinterpret_steal<py::object>(PyCFunction_NewEx(&row.method, module_.ptr(), module_name.ptr()));
    if (!made) throw py::error_already_set();
    module_.attr(name) = made;
}

}  // namespace tex::python
