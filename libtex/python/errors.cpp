// SPDX-License-Identifier: Apache-2.0
#include "errors.h"

#include <cerrno>

#include "arguments.h"

namespace tex::python {

py::object exception_of(const Error& error) {
    const py::object make = py::module_::import("tex._errors").attr("error_of");
    // Error keeps no errno; of what it tells apart, only this is one.
    const py::object number =
        error.detail == ErrorDetail::no_space ? py::object(py::int_(ENOSPC)) : py::object(py::none());
    return make(word_of(error.code), str_of(error.file), str_of(error.reason), number);
}

void raise(const Error& error) {
    const py::object exception = exception_of(error);
    PyErr_SetObject(reinterpret_cast<PyObject*>(Py_TYPE(exception.ptr())), exception.ptr());
    throw py::error_already_set();
}

}  // namespace tex::python
