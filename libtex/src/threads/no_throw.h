// SPDX-License-Identifier: Apache-2.0
// no_throw.h: keeps exceptions inside libtex. Every public function whose body may allocate memory runs it through
// no_throw().

#pragma once

#include <new>
#include <stdexcept>
#include <utility>

#include <tex/types.h>

#include "memory/lent_memory.h"

namespace tex::inline v1 {

inline Error out_of_memory_error() { return {ErrorCode::out_of_memory, {}, "out of memory"}; }

// Returns what `body` returns (a Result), or out_of_memory if the standard library could not allocate.
template <class Body>
auto no_throw(Body&& body) -> decltype(body()) {
    try {
        return std::forward<Body>(body)();
    } catch (const std::bad_alloc&) {
        return out_of_memory_error();
    } catch (const std::length_error&) {  // a container asked for more than any memory could hold
        return out_of_memory_error();
    }
}

// Runs a verb whose planes come from execution.allocate.
template <class Body>
auto no_throw(const Execution& execution, Body&& body) -> decltype(body()) {
    const RowAllocation own(execution.allocate);
    return no_throw(std::forward<Body>(body));
}

}  // namespace tex::inline v1
