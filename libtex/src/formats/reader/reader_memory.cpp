// SPDX-License-Identifier: Apache-2.0

#include "formats/reader/reader_memory.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <optional>

#include "files/input_file.h"

namespace tex {
namespace {

// nullopt if there is no /proc.
std::optional<std::uint64_t> address_space(pid_t process) {
    const Descriptor file(::open(("/proc/" + std::to_string(process) + "/statm").c_str(), O_RDONLY | O_CLOEXEC));
    char text[64];
    const ssize_t size = file ? read(file.get(), text, sizeof text) : -1;
    std::uint64_t pages = 0;
    if (size <= 0 || std::from_chars(text, text + size, pages).ec != std::errc()) return std::nullopt;
    return pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

}  // namespace

std::optional<std::uint64_t> claimed_result(const ReaderHeader& header, const std::string& verb, std::int64_t memory) {
    const auto most = static_cast<std::uint64_t>(std::max<std::int64_t>(memory, 0));
    std::uint64_t bytes = header.bytes;
    if (verb == "decode") {
        if (header.width == 0 && header.height == 0) return std::nullopt;
        const bool is_sound = header.width > 0 && header.height > 0 && header.channels > 0 &&
                              header.channels <= kMaxReaderChannels && header.type <= ReaderType::f32;
        if (!is_sound || row_bytes(header) > most / static_cast<std::uint64_t>(header.height)) return 0;
        bytes = row_bytes(header) * static_cast<std::uint64_t>(header.height);
    }
    if (bytes == 0) return std::nullopt;
    return bytes > most || most - bytes < kReaderDataOffset ? 0 : bytes + kReaderDataOffset;
}

void grant_result(pid_t process, std::uint64_t result, std::int64_t memory) {
    rlimit size{};
    rlimit space{};
    if (prlimit(process, RLIMIT_FSIZE, nullptr, &size) != 0 || size.rlim_cur != kReaderDataOffset ||
        prlimit(process, RLIMIT_AS, nullptr, &space) != 0)
        return;
    bool has_room = result > 0;
    if (has_room && space.rlim_cur != RLIM_INFINITY) {  // with sanitizers the address space is not limited
        const rlim_t left = std::min<rlim_t>(space.rlim_cur, static_cast<std::uint64_t>(memory) - result);
        const rlimit lower{left, left};
        has_room = prlimit(process, RLIMIT_AS, &lower, nullptr) == 0 && address_space(process).value_or(0) <= left;
    }
    // A limit that differs from the first one is the answer.
    size.rlim_cur = std::min<rlim_t>(size.rlim_max, has_room ? result : kReaderDataOffset + 1);
    prlimit(process, RLIMIT_FSIZE, &size, nullptr);
}

}  // namespace tex
