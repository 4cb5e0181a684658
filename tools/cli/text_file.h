// SPDX-License-Identifier: Apache-2.0
// text_file.h: the small files beside textures: lists, configurations, baselines, reports.

#pragma once

#include <string>

#include <tex/container.h>
#include <tex/result.h>

namespace tex::cli {

// The bytes of a file; "-" is standard input. Errors: io.
[[nodiscard]] Result<std::string> read_text_file(const std::string& path);

// write_file() of libtex, for text.
[[nodiscard]] Result<void> write_text_file(const std::string& path, const std::string& text,
                                           const WriteOptions& options = {});

}  // namespace tex::cli
