// SPDX-License-Identifier: Apache-2.0
// output_file.h: an output that is being written: a large one in its file, a small one in memory.

#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <tex/types.h>

#include "files/atomic_file.h"

namespace tex::inline v1 {

// When the file is opened. If many files are written at once (one for each level), they should not use many
// descriptors, and FIFOs among them must be opened one after the other, in the order in which their reader opens them.
enum class Opened { at_once, late };

class OutputFile {
public:
    // `bytes` is the approximate size of the file. Errors: as AtomicFile::open(), here or from commit().
    static Result<std::unique_ptr<OutputFile>> open(const std::string& path, std::size_t bytes, Opened when,
                                                    const AtomicFileOptions& options);

    // See AtomicFile.
    Result<void> write_at(std::uint64_t offset, std::span<const std::byte> bytes);
    Result<void> commit();

private:
    OutputFile(std::string path, const AtomicFileOptions& options) : path_(std::move(path)), options_(options) {}

    const std::string path_;
    const AtomicFileOptions options_;
    std::optional<AtomicFile> file_;
    bool holds_ = false;  // whether bytes are held in memory until commit()
    std::mutex mutex_;    // guards held_
    std::vector<std::byte> held_;
};

}  // namespace tex::inline v1
