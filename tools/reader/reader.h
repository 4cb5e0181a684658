// SPDX-License-Identifier: Apache-2.0
// reader.h: what the reader programs share: tex-reader (tools/reader), tex-reader-oiio (tools/oiio-reader) and
// tex-mesh-reader (tools/mesh-reader). Each of them reads one file, or encodes one picture, and ends.
// reader_protocol.h describes requests and answers.

#pragma once

#include <charconv>
#include <cstdint>
#include <string>
#include <string_view>
#include <system_error>

#include <tex/types.h>

#include "formats/reader/reader_protocol.h"

// Sanitizers map terabytes of shadow memory, and check memory through pipes. With them the address space stays
// unlimited and pipes are allowed.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define TEX_READER_SHADOW 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || __has_feature(memory_sanitizer)
#define TEX_READER_SHADOW 1
#endif
#endif

namespace tex::reader {

struct Task {
    std::string verb;             // "decode", "encode", "describe", "mesh" or "draco"
    std::string format;           // the name of the file type; the extension of a mesh
    std::int64_t max_texels = 0;  // a picture with more texels is refused
    std::int64_t memory = 0;      // bytes of address space, the result included
    int seconds = 1;              // of processor time
    int parent = 0;               // process id; the program ends when its parent ends
};

// Does the work, once the process is restricted. The answer is in kResultDescriptor. Returns false after a refusal.
using Work = bool (*)(const Task& task, ReaderHeader& header);

// A whole program: takes the task from the arguments of the command line, and does it under its limits. Returns the
// exit status. --version prints `version`, and what the kernel grants.
int run_program(const char* name, const char* version, int argc, char** argv, Work work);

// The work alone, under its limits: hands over the header and the result.
void run_task(const Task& task, Work work);

// Reads a whole argument as a number.
template <class T>
bool parse_number(std::string_view text, T& value) {
    const auto [last, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && last == text.data() + text.size();
}

// Limits memory, time and descriptors, disables the core file, and makes the process end when its parent ends.
void limit_process(const Task& task);
// The last of these; without a sandbox (TEX_SANDBOX=OFF), the end of the parent is seen when rows are handed over.
void end_with_parent();

// The number of bytes that this process may use: Task::memory, or less if the process inherited lower limits.
std::int64_t memory_limit();

// Denies this thread, and those that it starts later, access to all files but the input, which may be read. If the
// kernel supports it, this also denies TCP and signals to other processes (Landlock). Returns false if the kernel lacks
// Landlock or refuses.
bool restrict_files();

// The kernel's version of Landlock; 0 if it has none.
int landlock_version();

// Denies every thread the system calls that a decoder does not need: the network, opening files for writing, other
// programs, other processes (seccomp). Returns false if the kernel refuses the filter. If either restriction is
// refused, the other one and the limits still apply.
bool filter_calls();

// Checks the extent and the channels of the picture that the header describes, hands the header over, and reserves
// memory for the texels. Returns false after a refusal. Throws std::bad_alloc.
bool begin_picture(const Task& task, ReaderHeader& header);

// Reserves memory for a result of this size: pages of the result are no address space of any process, but count as if
// they were. Throws std::bad_alloc.
void reserve_result(std::uint64_t bytes);

// Writes the header; if that fails, the process ends with kNoRoom.
void put_header(const ReaderHeader& header);
// Throws std::bad_alloc if the result has no room for the bytes.
void put_bytes(std::uint64_t offset, const void* data, std::uint64_t count);
// Hands over rows of a picture, which are the next ones from the top, and tells the parent.
void put_rows(ReaderHeader& header, const void* rows, int count);
// Hands over an encoded file. Returns true. Throws std::bad_alloc.
bool put_file(ReaderHeader& header, const void* data, std::uint64_t bytes);
// Writes bytes of the result; false if it has no room for them.
bool write_result(std::uint64_t offset, const void* data, std::uint64_t count);
// Tells the parent that rows have arrived.
void put_progress();
// Makes new memory hold zeros, and heaps take less address space, as far as the C library can do that.
void settle_memory();
// Whether a thread could start. The system refuses it also if there is no room for its stack.
bool has_room_for_a_thread();
// Ends the process, or what stands for it, after a refusal.
[[noreturn]] void leave(int status);
// Reads bytes of the input; false if they are not there.
bool read_input(std::uint64_t offset, void* to, std::uint64_t count);

// Report failure. Both return false.
bool refuse(ReaderHeader& header, ErrorCode code, const std::string& reason);
bool refuse_memory(ReaderHeader& header, const Task& task);

}  // namespace tex::reader
