// SPDX-License-Identifier: Apache-2.0

#include "cli/text_file.h"

#include <cerrno>
#include <cstdio>
#include <memory>
#include <vector>

#include "files/system_error.h"

namespace tex::cli {

Result<std::string> read_text_file(const std::string& path) {
    const bool from_stdin = path == "-";
    const std::unique_ptr<FILE, int (*)(FILE*)> opened(
        from_stdin ? nullptr : std::fopen(path.c_str(), "rbe"),
        [](FILE* file) { return file == nullptr ? 0 : std::fclose(file); });
    FILE* file = from_stdin ? stdin : opened.get();
    const auto failed = [&] {
        return Error{ErrorCode::io, from_stdin ? "standard input" : path, system_reason(errno)};
    };
    if (file == nullptr) return failed();
    std::string text;
    char buffer[65536];
    while (const std::size_t count = std::fread(buffer, 1, sizeof buffer, file)) text.append(buffer, count);
    if (std::ferror(file) != 0) return failed();
    return text;
}

Result<void> write_text_file(const std::string& path, const std::string& text, const WriteOptions& options) {
    const auto* bytes = reinterpret_cast<const std::byte*>(text.data());
    return write_file(path, std::vector<std::byte>(bytes, bytes + text.size()), options);
}

}  // namespace tex::cli
