// SPDX-License-Identifier: Apache-2.0
// reader_memory.h: one limit for all the memory that a reader process uses: its own and that of its result.
//
// The system limits the two separately: address space by RLIMIT_AS, and the size of files by RLIMIT_FSIZE. Pages of a
// file in memory do not count as the address space of any process. At first, a reader may use all of the memory as
// address space, and its result may hold no more than the header. When the header states the size of the result, libtex
// moves that number of bytes from one limit to the other.

#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <sys/types.h>

#include "formats/reader/reader_protocol.h"

namespace tex {

// The number of bytes of the result, from its beginning, that the header claims. nullopt if it does not claim a size
// yet; 0 if the claim is impossible or greater than `memory`.
std::optional<std::uint64_t> claimed_result(const ReaderHeader& header, const std::string& verb, std::int64_t memory);

// Changes the limits of the process, which may use `memory` bytes in all. A process that already uses too much gets no
// room for its result. Limits that are not set, those of other programs, do not change.
void grant_result(pid_t process, std::uint64_t result, std::int64_t memory);

}  // namespace tex
