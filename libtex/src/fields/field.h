// SPDX-License-Identifier: Apache-2.0
// field.h: the tables of fields: for each structure of options, its fields' names, and the numbers or words that each
// accepts. They stand once, in fields/<header>_fields.h; validate(), the command line and Python read them.
//
// A table is a function each_field(options, f), which calls f once for each field:
//
//     f("name", options.member);                          any value; a structure with a table of its own is checked
//     f("name", options.member, Range{0.0, 256.0});       a number
//     f("name", options.member, kWrapNames);              an enumerator
//     f("name", axes(options.name_x, options.name_y), ...);   two fields, one for each axis
//
// A function rather than an array, because the fields of a structure have different types.

#pragma once

#include <concepts>
#include <type_traits>

#include <tex/types.h>

#include "fields/range.h"

namespace tex::inline v1 {

// T, or what is derived from it: the first parameter of a table.
template <class O, class T>
concept Of = std::derived_from<std::remove_const_t<O>, T>;

// The fields of a structure for x and y.
template <class T>
struct Axes {
    T& x;
    T& y;
};
template <class T>
[[nodiscard]] Axes<T> axes(T& x, T& y) {
    return {x, y};
}

// Finds the range of the field at an address.
class RangeSearch {
public:
    explicit RangeSearch(const void* field) : field_(field) {}

    template <class... Rest>
    void operator()(const char*, const Rest&...) {}
    template <class T>
    void operator()(const char*, const T& value, const Range& range) {
        if (&value == field_) found = range;
    }
    template <class T>
    void operator()(const char* name, Axes<T> value, const Range& range) {
        (*this)(name, value.x, range);
        (*this)(name, value.y, range);
    }

    Range found;

private:
    const void* field_;
};

// The range of a field: range_of(&HeightOptions::blur_sigma). A field without one accepts every number.
template <class O, class T>
[[nodiscard]] Range range_of(T O::*field) {
    const O options{};
    RangeSearch search(&(options.*field));
    each_field(options, search);
    return search.found;
}

}  // namespace tex::inline v1
