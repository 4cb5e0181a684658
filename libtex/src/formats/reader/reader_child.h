// SPDX-License-Identifier: Apache-2.0
// reader_child.h: a process that reads one file.

#pragma once

#include <cstdint>
#include <string>

#include <sys/types.h>

namespace tex::inline v1 {

enum class ReaderProgram { pictures, other_pictures, meshes };  // tex-reader, tex-reader-oiio, tex-mesh-reader

// What a reader does, the descriptor that it works on, and where the result goes.
struct ReaderJob {
    ReaderProgram program = ReaderProgram::pictures;
    std::string path;  // for messages
    std::string verb;  // "decode", "encode", "describe", "mesh" or "draco"
    std::string format;
    int input = -1;
    int result = -1;  // a memory_file()
};

struct ReaderLimits {
    std::int64_t max_texels = 0;
    std::int64_t memory = 0;  // bytes
    int seconds = 1;
};

// How a process ended; all zeros if another part of this program collected it.
struct Ending {
    int signal = 0;
    int status = 0;
};

class ReaderChild {
public:
    ReaderChild() = default;
    explicit ReaderChild(pid_t id) : id_(id) {}
    ReaderChild(ReaderChild&& other) noexcept;
    ReaderChild& operator=(ReaderChild&& other) noexcept;
    ~ReaderChild();  // as end()

    explicit operator bool() const { return id_ > 0; }
    [[nodiscard]] pid_t id() const { return id_; }

    // Ends the process if it still runs, and says how it ended. Afterwards there is none.
    Ending end();

private:
    pid_t id_ = -1;
};

// Starts the program for one job, which writes its progress to this descriptor. Returns 0 or an errno.
int start_reader(const std::string& program, const ReaderJob& job, int progress, const ReaderLimits& limits,
                 ReaderChild& child);

}  // namespace tex::inline v1
