// SPDX-License-Identifier: Apache-2.0
// scratch_file.h: a file without a name that holds bytes until this process reads them again.

#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <tex/types.h>

#include "files/input_file.h"

namespace tex::inline v1 {

class ScratchFile {
public:
    // The bytes are on the disk that holds `output`; in memory if the folder takes no file without a name. Errors: io,
    // out_of_memory.
    static Result<ScratchFile> open(const std::string& output);

    // Any thread may call these. Errors: io, which names the output. read_at() may throw std::bad_alloc; it must not
    // read beyond the last byte.
    [[nodiscard]] Result<void> write_at(std::uint64_t offset, std::span<const std::byte> bytes) const;
    [[nodiscard]] Result<std::vector<std::byte>> read_at(std::uint64_t offset, std::size_t count) const;

private:
    ScratchFile(Descriptor file, std::string output) : file_(std::move(file)), output_(std::move(output)) {}

    Descriptor file_;
    std::string output_;  // for error messages
};

}  // namespace tex::inline v1
