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

#include <tex/types.h>

#include "files/scratch_file.h"
#include "formats/exr/exr_block.h"

namespace tex::inline v1 {

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
    struct Moved {
        std::uint64_t at;  // in the scratch file
        std::size_t count;
        std::vector<std::size_t> sizes;
    };
    Result<void> move_last();

    std::string output_;
    std::map<int, ExrChunks> held_;  // in memory; by number
    std::size_t held_bytes_ = 0;
    std::map<int, Moved> moved_;  // to the scratch file
    std::optional<ScratchFile> scratch_;
    std::uint64_t end_ = 0;  // of the scratch file
};

}  // namespace tex::inline v1
