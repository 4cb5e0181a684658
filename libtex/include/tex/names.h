// SPDX-License-Identifier: Apache-2.0
// names.h: the names of enumerators.
//
// Every enum that a user can choose from has one table of names beside its definition, called k<Enum>Names. The command
// line, the help, the reports and the error messages all read that table, so a value has the same name everywhere.
// Tables are in the order in which help lists them.

#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

#pragma GCC visibility push(default)
namespace tex {

// One row of a name table: the enumerator, its name as a user types it (lower case, words joined by "-"), and one
// clause that explains it in the help.
template <class E>
struct Named {
    E value;
    std::string_view name;
    std::string_view meaning;
};

// The name of `value` in `table`; an empty view if the table does not list it.
template <class E, std::size_t N>
constexpr std::string_view name_of(const Named<E> (&table)[N], E value) {
    for (const Named<E>& row : table) {
        if (row.value == value) return row.name;
    }
    return {};
}

// The enumerator called `name` (exact, case-sensitive); nullopt if the table does not list it.
template <class E, std::size_t N>
constexpr std::optional<E> find_by_name(const Named<E> (&table)[N], std::string_view name) {
    for (const Named<E>& row : table) {
        if (row.name == name) return row.value;
    }
    return std::nullopt;
}

}  // namespace tex
#pragma GCC visibility pop
