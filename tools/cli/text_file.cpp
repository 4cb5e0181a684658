// SPDX-License-Identifier: Apache-2.0

#include "cli/text_file.h"

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "cli/file_status.h"
#include "files/system_error.h"

namespace tex::cli {

namespace {

// `Bytes` is a string or a vector of bytes.
template <class Bytes>
Result<Bytes> read_whole(const std::string& path, std::size_t most) {
    const bool from_stdin = path == "-";
    const ReadFile opened = open_to_read(from_stdin ? "" : path);
    FILE* file = from_stdin ? standard_input() : opened.get();
    const std::string name = from_stdin ? "standard input" : path;
    const auto failed = [&] { return Error{ErrorCode::io, name, system_reason(errno)}; };
    if (file == nullptr) return failed();
    const std::optional<FileStatus> status = status_of_open(file);
    const bool has_size = status && status->is_regular();
    if (!has_size) most = std::min(most, kMostOfTextFile);
    const auto excess = [&] { return Error{ErrorCode::bad_data, name, fmt::format("has more than {} bytes", most)}; };
    Bytes read;
    if (has_size && status->size > 0) {
        const auto size = static_cast<std::uint64_t>(status->size);
        if (size > most && !from_stdin) return excess();
        read.reserve(static_cast<std::size_t>(std::min<std::uint64_t>(size, most)));
    }
    typename Bytes::value_type buffer[65536];
    while (const std::size_t count = std::fread(buffer, 1, sizeof buffer, file)) {
        if (count > most - read.size()) return excess();
        read.insert(read.end(), buffer, buffer + count);
    }
    if (std::ferror(file) != 0) return failed();
    return read;
}

}  // namespace

Result<std::string> read_text_file(const std::string& path, std::size_t most) {
    return read_whole<std::string>(path, most);
}

Result<std::vector<std::byte>> read_binary_file(const std::string& path) {
    return read_whole<std::vector<std::byte>>(path, PTRDIFF_MAX);
}

Result<void> write_text_file(const std::string& path, const std::string& text, const WriteOptions& options) {
    const auto* bytes = reinterpret_cast<const std::byte*>(text.data());
    return write_file(path, std::vector<std::byte>(bytes, bytes + text.size()), options);
}

bool is_special_file(const std::string& path) {
    if (path == "-") return true;
    const auto status = status_of(path);
    return status && status->kind == FileKind::special;
}

Result<void> write_document(const std::string& path, const std::string& text, WriteOptions options) {
    options.follow_links = is_special_file(path);
    return write_text_file(path, text, options);
}

}  // namespace tex::cli
