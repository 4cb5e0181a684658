// SPDX-License-Identifier: Apache-2.0
// reader.h: the parts of tex-reader, the one program that links OpenImageIO.
//
// reader_protocol.h describes requests and answers. It reads one file, or encodes one picture, and ends.

#pragma once

#include <cstdint>
#include <string>

#include <tex/result.h>

#include "formats/reader/reader_protocol.h"

namespace tex::reader {

struct Task {
    std::string format;           // as OpenImageIO names it
    std::int64_t max_texels = 0;  // more are refused
    std::int64_t memory = 0;      // bytes of address space and of the result, together
    int seconds = 1;              // of processor time
    int parent = 0;               // ends with it
};

// Limits of memory, time and descriptors; no core file; ends when the parent does.
void limit_process(const Task& task);

// Bytes that this process may have: Task::memory, or less where it came with lower limits.
std::int64_t memory_limit();

// Waits until libtex has answered the header with room for the result (reader_memory.h). The room may be too small:
// then put_bytes() fails. The time limit of the process is the one of this, too.
void wait_for_room();

// Takes away all files but the input, which may be read, from every thread; if the kernel can, TCP and signals to other
// processes, too (Landlock). False if the kernel does not know it, or refuses.
bool restrict_files();

// The kernel's version of Landlock; 0 if it has none.
int landlock_version();

// Takes away the system calls that a decoder needs no more: the network, opening files for writing, other programs,
// other processes (seccomp). False if the kernel refuses the filter. If either is refused, the other and the
// limits stay.
bool filter_calls();

// Both answer in kResultDescriptor and return false after they have refused.
bool decode(const Task& task, ReaderHeader& header);
bool encode(const Task& task, ReaderHeader& header);

// Writes the header; if that fails, the process ends with kNoRoom.
void put_header(const ReaderHeader& header);
// Throws std::bad_alloc if the result has no room for them.
void put_bytes(std::uint64_t offset, const void* data, std::uint64_t count);
// Tells the parent that rows have arrived.
void put_progress();
// Reports failure; returns false.
bool refuse(ReaderHeader& header, ErrorCode code, const std::string& reason);

}  // namespace tex::reader
