// SPDX-License-Identifier: Apache-2.0
// reader_memory.h: one bound for all the memory that a reader process takes: its own and that of its result.
//
// The system counts the two apart: address space (RLIMIT_AS), and the size of files (RLIMIT_FSIZE), since pages of a
// file in memory belong to nobody's address space. A reader begins with all of the memory as address space, and with no
// more of a result than its header. When that says how large the result is going to be, libtex moves so much from one
// limit to the other.

#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <sys/types.h>

#include "formats/reader/reader_protocol.h"

namespace tex {

// Bytes of the result, from its beginning, that the header claims: nothing if it does not say yet, 0 if it says what
// cannot be, or more than `memory`.
std::optional<std::uint64_t> claimed_result(const ReaderHeader& header, const std::string& verb, std::int64_t memory);

// Moves the limits of the process, whose bound is `memory`. A process that holds too much already gets no room for its
// result. Limits that are not set, those of other programs, stay.
void grant_result(pid_t process, std::uint64_t result, std::int64_t memory);

}  // namespace tex
