// SPDX-License-Identifier: Apache-2.0
#include "errors.h"

#include "arguments.h"

namespace tex::python {

py::object exception_of(const Error& error) {
    // Texts of files are bytes, which need not be UTF-8: as Python reads names of files.
    const auto text = [](const std::string& bytes) {
        return py::reinterpret_steal<py::object>(
            PyUnicode_DecodeFSDefaultAndSize(bytes.data(), static_cast<Py_ssize_t>(bytes.size())));
    };
    const py::object make = py::module_::import("tex._errors").attr("error_of");
    return make(word_of(error.code), text(error.file), text(error.reason));
}

void raise(const Error& error) {
    const py::object exception = exception_of(error);
    PyErr_SetObject(reinterpret_cast<PyObject*>(Py_TYPE(exception.ptr())), exception.ptr());
    throw py::error_already_set();
}

}  // namespace tex::python
