// SPDX-License-Identifier: Apache-2.0
// here_windows.h: the job of a decoder that runs in a thread of its caller.

#pragma once

#include <cstdint>
#include <functional>

#include "decoders.h"

namespace tex::reader {

struct Here {
    int input = -1, result = -1;
    std::int64_t memory = 0;  // bytes that the result may have
    const std::function<void()>* progress = nullptr;
    std::uint64_t reserved = 0;

    // Reads bytes of the input; false if they are not there. Any thread may call these.
    bool read(std::uint64_t offset, void* to, std::uint64_t count) const;
    [[nodiscard]] std::uint64_t size() const;
};

// The job of this thread.
Here& here();

}  // namespace tex::reader
