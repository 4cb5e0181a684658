// SPDX-License-Identifier: Apache-2.0
// field_check.h: checks the values of a structure's fields by its table.

#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>

#include <tex/types.h>

#include "fields/field.h"
#include "rows/usable.h"

namespace tex::inline v1 {

// Finds the first field whose value is not accepted.
class FieldCheck {
public:
    explicit FieldCheck(std::string prefix = {}) : prefix_(std::move(prefix)) {}

    template <class T>
    void operator()(const char* name, const T& value) {
        if constexpr (requires(FieldCheck inner) { each_field(value, inner); }) {
            FieldCheck inner(prefix_ + name + ".");
            each_field(value, inner);
            found(std::move(inner.error));
        }
    }
    template <class T>
    void operator()(const char* name, const std::optional<T>& value) {
        if (value) (*this)(name, *value);
    }
    template <class T>
    void operator()(const char*, Axes<T>) {}

    template <class T>
    void operator()(const char* name, const T& value, const Range& range) {
        if (!contains(range, value)) found(bad_option(prefix_ + name + ": " + requirement(range)));
    }
    template <class T>
    void operator()(const char* name, const std::optional<T>& value, const Range& range) {
        if (value) (*this)(name, *value, range);
    }
    template <class T>
    void operator()(const char* name, Axes<T> value, const Range& range) {
        (*this)(name, value.x, range);
        (*this)(name, value.y, range);
    }

    template <class T, class E, std::size_t N>
    void operator()(const char* name, const T& value, const Named<E> (&words)[N]) {
        found(check_known(prefix_ + name, words, value));
    }
    template <class T, class E, std::size_t N>
    void operator()(const char* name, const std::optional<T>& value, const Named<E> (&words)[N]) {
        if (value) (*this)(name, *value, words);
    }
    template <class T, class E, std::size_t N>
    void operator()(const char* name, Axes<T> value, const Named<E> (&words)[N]) {
        found(check_known(prefix_ + name + "_x", words, value.x));
        found(check_known(prefix_ + name + "_y", words, value.y));
    }

    Result<void> error;  // or success

private:
    void found(Result<void> result) {
        if (error) error = std::move(result);
    }

    std::string prefix_;
};

// Whether every field has a value that its table accepts. Errors: bad_option, which names the field.
template <class O>
[[nodiscard]] Result<void> check_fields(const O& options) {
    FieldCheck check;
    each_field(options, check);
    return std::move(check.error);
}

}  // namespace tex::inline v1
