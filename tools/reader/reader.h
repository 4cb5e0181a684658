// SPDX-License-Identifier: Apache-2.0
// reader.h: the parts of tex-reader, the one program that links OpenImageIO. tex-mesh-reader uses those that do not
// know OpenImageIO: job.cpp, landlock.cpp and sandbox.cpp.
//
// reader_protocol.h describes requests and answers. tex-reader decodes one file, or encodes one picture, and ends. Or
// it is the zygote, which forks a process for each file; that process does the same.

#pragma once

#include <charconv>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

#include <tex/result.h>

#include "formats/reader/reader_protocol.h"

namespace tex::reader {

struct Task {
    std::string verb;             // "decode", "encode", "describe" or "mesh"
    std::string format;           // OpenImageIO's name of the format; the extension of a mesh
    std::int64_t max_texels = 0;  // a picture with more texels is refused
    std::int64_t memory = 0;      // bytes of address space and of the result, together
    int seconds = 1;              // of processor time
    int parent = 0;               // process id; tex-reader ends when its parent ends
};

// What a reader program does.
struct Work {
    void (*prepare)();                                    // before it is restricted
    bool (*run)(const Task& task, ReaderHeader& header);  // false after a refusal
};

extern const Work kPictures;

// Does the work, under the limits of the task. Returns the exit status; the answer is in kResultDescriptor.
int run(const Task& task, const Work& work);

// Reads a whole argument as a number.
template <class T>
bool parse_number(std::string_view text, T& value) {
    const auto [last, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && last == text.data() + text.size();
}

// Reads a task from the arguments of the command line. False if they are not those of reader_protocol.h.
bool parse_task(int argc, char** argv, Task& task);

// Serves requests that arrive at kRequestsDescriptor, each in a process that it forks, until the socket is closed or
// the parent has ended. Returns the exit status.
int serve(int parent);

// Turns off what a decoder could use besides its input file: threads and plug-ins. (The process has no environment.)
void calm_openimageio();

// Limits memory, time and descriptors, disables the core file, and makes the process end when its parent ends.
void limit_process(const Task& task);

// The number of bytes that this process may use: Task::memory, or less if the process inherited lower limits.
std::int64_t memory_limit();

// Waits until libtex has answered the header by providing room for the result (reader_memory.h). The room may be too
// small; then put_bytes() fails. The time limit of the process also applies to the wait.
void wait_for_room();

// Denies every thread access to all files but the input, which may be read. If the kernel supports it, this also denies
// TCP and signals to other processes (Landlock). Returns false if the kernel lacks Landlock or refuses.
bool restrict_files();

// The kernel's version of Landlock; 0 if it has none.
int landlock_version();

// Denies the system calls that a decoder no longer needs: the network, opening files for writing, other programs, other
// processes (seccomp). Returns false if the kernel refuses the filter. If either restriction is refused, the other one
// and the limits still apply.
bool filter_calls();

// The same for the zygote, before its first request. It and its children may still read files, until the children call
// restrict_files(), and start processes, but not programs.
bool restrict_files_of_zygote();
bool filter_calls_of_zygote();

// Reads what the input, a TIFF, says about its samples: the value of texels without data (GDAL_NODATA), GDAL's scale
// and offset, and whether the picture has a place on the Earth.
void read_tiff_tags(ReaderHeader& header);

// Both send their answer to kResultDescriptor. After a refusal they return false.
bool decode(const Task& task, ReaderHeader& header);
bool encode(const Task& task, ReaderHeader& header);

// Writes the header; if that fails, the process ends with kNoRoom.
void put_header(const ReaderHeader& header);
// Throws std::bad_alloc if the result has no room for the bytes.
void put_bytes(std::uint64_t offset, const void* data, std::uint64_t count);
// Tells the parent that rows have arrived.
void put_progress();
// Reports failure; returns false.
bool refuse(ReaderHeader& header, ErrorCode code, const std::string& reason);

}  // namespace tex::reader
