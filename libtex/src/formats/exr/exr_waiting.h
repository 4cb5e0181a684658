// SPDX-License-Identifier: Apache-2.0
// exr_waiting.h: blocks of an EXR that are compressed and wait for their place in the file.

#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <tex/result.h>

#include "files/scratch_file.h"
#include "formats/exr/exr_block.h"

namespace tex {

// Small levels wait until the larger ones are in the file: a third of all bytes. Those that must wait longest go to a
// scratch file as soon as all take more than kMostHeld bytes.
class ExrWaitingBlocks {
public:
    static constexpr std::size_t kMostHeld = std::size_t{4} << 20;

    // Allows a scratch file beside `output`. Without it, all blocks wait in memory.
    void wait_beside(const std::string& output) { output_ = output; }

    // Adds block `number`, once. Throws std::bad_alloc. Errors: io.
    Result<void> add(int number, ExrChunks chunks);

    // Takes block `number`, if it waits. Throws std::bad_alloc. Errors: io.
    Result<std::optional<ExrChunks>> take(int number);

private:
    struct Waiting {
        ExrChunks chunks;      // without bytes, if these are in the scratch file
        std::uint64_t at = 0;  // there
        std::size_t count = 0;
        bool is_held = true;
    };
    Result<void> move_out(Waiting& block);

    std::string output_;
    std::map<int, Waiting> blocks_;  // by number
    std::size_t held_ = 0;           // bytes in memory
    std::optional<ScratchFile> scratch_;
    std::uint64_t end_ = 0;  // of the scratch file
};

}  // namespace tex
