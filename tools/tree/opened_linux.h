// SPDX-License-Identifier: Apache-2.0
// opened_linux.h: a file or folder that is open, for what looks at files through open folders. (The library has a
// Descriptor of its own, which it does not export.)

#pragma once

#include <utility>

#include <unistd.h>

namespace tex::cli {

class Opened {
public:
    explicit Opened(int fd) : fd_(fd) {}
    Opened(const Opened&) = delete;
    Opened& operator=(const Opened&) = delete;
    ~Opened() {
        if (fd_ >= 0) close(fd_);
    }
    [[nodiscard]] int get() const { return fd_; }
    explicit operator bool() const { return fd_ >= 0; }
    // Takes another descriptor, and closes its own.
    void become(int fd) { const Opened before(std::exchange(fd_, fd)); }

private:
    int fd_;
};

}  // namespace tex::cli
