// SPDX-License-Identifier: Apache-2.0
// errors.h: tex::Error as a Python exception. tex/_errors.py defines the classes.

#pragma once

#include <utility>

#include <pybind11/pybind11.h>
#include <tex/types.h>

namespace tex::python {

namespace py = pybind11;

// The exception for an error, as an object.
[[nodiscard]] py::object exception_of(const Error& error);

[[noreturn]] void raise(const Error& error);

// The value of a result, or the exception of its error.
template <class T>
T value_of(Result<T>&& result) {
    if (!result) raise(result.error());
    if constexpr (!std::is_void_v<T>) return std::move(*result);
}

}  // namespace tex::python
