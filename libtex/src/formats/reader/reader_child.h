// SPDX-License-Identifier: Apache-2.0
// reader_child.h: a process that reads one file, started from its program or forked by the zygote.

#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include <sys/types.h>

#include "files/input_file.h"
#include "formats/reader/reader_protocol.h"

namespace tex {

using ReaderClock = std::chrono::steady_clock;

// What a reader does, the descriptor that it works on, and where the result goes.
struct ReaderJob {
    std::string path;  // for messages
    std::string verb;  // "decode", "encode", "describe" or "mesh"
    std::string format;
    int input = -1;
    int result = -1;  // a memory_file()
};

struct ReaderLimits {
    std::int64_t max_texels = 0;
    std::int64_t memory = 0;  // bytes
    int seconds = 1;
    ReaderClock::time_point deadline;
};

// How a process ended; all zeros if another part of this program collected it.
struct Ending {
    int signal = 0;
    int status = 0;
    bool is_unknown = false;  // the zygote, which alone could say so, has ended too
};

class ReaderChild {
public:
    ReaderChild() = default;
    // A child of this process.
    explicit ReaderChild(pid_t id) : id_(id) {}
    // A child of the zygote, which reports its end to this socket and lives as long as the child.
    ReaderChild(pid_t id, Descriptor news, std::shared_ptr<const void> zygote)
        : id_(id), news_(std::move(news)), zygote_(std::move(zygote)) {}
    ReaderChild(ReaderChild&& other) noexcept;
    ReaderChild& operator=(ReaderChild&& other) noexcept;
    ~ReaderChild();  // as end()

    explicit operator bool() const { return id_ > 0; }
    [[nodiscard]] pid_t id() const { return id_; }

    // Ends the process if it still runs, and says how it ended. Afterwards there is none.
    Ending end();

private:
    pid_t id_ = -1;
    Descriptor news_;
    std::shared_ptr<const void> zygote_;
};

// Starts the program for one job, which writes its progress to this descriptor. Returns 0 or an errno.
int start_reader(const std::string& program, const ReaderJob& job, int progress, const ReaderLimits& limits,
                 ReaderChild& child);

// Waits for a message of the zygote. False if it has closed the socket, if the message is nonsense, or if the time is
// up.
bool receive_news(int socket, ReaderNews& news, ReaderClock::time_point deadline);

}  // namespace tex
