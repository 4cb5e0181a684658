// SPDX-License-Identifier: Apache-2.0
// output_file.h: an output on its way: a large one grows in its file, a small one in memory.

#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <tex/result.h>

#include "files/atomic_file.h"

namespace tex {

// When the file is opened. Many that are written at once (a file for each level) are not to take many descriptors, and
// FIFOs among them are to be opened one after the other, as their reader does.
enum class Opened { at_once, late };

class OutputFile {
public:
    // `bytes` is about the size that the file will have. Errors: as AtomicFile::open(), here or from commit().
    static Result<std::unique_ptr<OutputFile>> open(const std::string& path, std::size_t bytes, Opened when,
                                                    const AtomicFileOptions& options);

    // As AtomicFile.
    Result<void> write_at(std::uint64_t offset, std::span<const std::byte> bytes);
    Result<void> commit();

private:
    OutputFile(std::string path, const AtomicFileOptions& options) : path_(std::move(path)), options_(options) {}

    const std::string path_;
    const AtomicFileOptions options_;
    std::optional<AtomicFile> file_;
    bool holds_ = false;  // until commit()
    std::mutex mutex_;    // of held_
    std::vector<std::byte> held_;
};

}  // namespace tex
