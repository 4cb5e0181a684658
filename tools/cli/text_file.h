// SPDX-License-Identifier: Apache-2.0
// text_file.h: the small files beside textures: lists, configurations, baselines, reports.

#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <tex/file.h>
#include <tex/types.h>

namespace tex::cli {

// The most bytes of lists and baselines. It also ends the reading of devices such as /dev/zero.
inline constexpr std::size_t kMostOfTextFile = std::size_t{64} << 20;
// The most bytes of states, plans and reports of whole trees.
inline constexpr std::size_t kMostOfRecord = std::size_t{1} << 30;

// The bytes of a file; "-" is standard input. Errors: io; bad_data, if there are more than `most` bytes, or more than
// kMostOfTextFile in what is no regular file. A regular file says so before any of it is read.
[[nodiscard]] Result<std::string> read_text_file(const std::string& path, std::size_t most = kMostOfTextFile);

// The bytes of a texture or of another file that is kept in memory. Errors: io.
[[nodiscard]] Result<std::vector<std::byte>> read_binary_file(const std::string& path);

// Whether a write to `path` goes through: to standard output, a FIFO or a device.
[[nodiscard]] bool is_special_file(const std::string& path);

// write_file() of libtex, for text.
[[nodiscard]] Result<void> write_text_file(const std::string& path, const std::string& text,
                                           const WriteOptions& options = {});

// Writes reports and other documents: a link that has the name is replaced, so that nobody can choose by a link
// which file is written.
[[nodiscard]] Result<void> write_document(const std::string& path, const std::string& text, WriteOptions options = {});

}  // namespace tex::cli
