// SPDX-License-Identifier: Apache-2.0
// through_file.h: standard output, FIFOs and devices, which are written directly.

#pragma once

#include <charconv>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <tex/types.h>

#include "files/input_file.h"

namespace tex::inline v1 {

// The descriptor that "-", /dev/stdout, /dev/fd/N or /proc/self/fd/N names. It is written directly even if it refers to
// a regular file, because the shell that opened the file keeps it open. (Inline, so that the commands can use it too.)
inline std::optional<int> named_descriptor(std::string_view path) {
    if (path == "-" || path == "/dev/stdout") return kStandardOutput;
    for (const std::string_view folder : {"/dev/fd/", "/proc/self/fd/"}) {
        if (!path.starts_with(folder)) continue;
        path.remove_prefix(folder.size());
        int fd = -1;
        const auto [end, error] = std::from_chars(path.data(), path.data() + path.size(), fd);
        if (error == std::errc() && end == path.data() + path.size()) return fd;
        return std::nullopt;
    }
    return std::nullopt;
}

class ThroughFile {
public:
    // nullopt if `path` is, or will be, a regular file. Errors: io; cancelled, see write_file().
    static Result<std::optional<ThroughFile>> open(const std::string& path);

    // Appends bytes to those already written. Errors: io.
    Result<void> write(std::span<const std::byte> bytes);

    // Keeps bytes in memory until write_held(), because nothing may be written that a later error would make useless.
    // Any thread may call this. Throws std::bad_alloc.
    void hold(std::uint64_t offset, std::span<const std::byte> bytes);
    // Writes all bytes that are held, in order, with zeros in the gaps. Errors: io.
    Result<void> write_held();

private:
    ThroughFile(std::string path, Descriptor owned, int fd);

    std::string path_;
    Descriptor owned_;  // set if this object owns fd_
    int fd_;
    std::unique_ptr<std::mutex> mutex_;
    std::map<std::uint64_t, std::vector<std::byte>> held_;  // by offset
};

}  // namespace tex::inline v1
