// SPDX-License-Identifier: Apache-2.0

#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <new>
#include <string_view>

#include "reader.h"

namespace tex::reader {
namespace {

bool parse_task(int argc, char** argv, Task& task) {
    if (argc != 7 || !parse_number(argv[3], task.max_texels) || !parse_number(argv[4], task.memory) ||
        !parse_number(argv[5], task.seconds) || !parse_number(argv[6], task.parent))
        return false;
    task.verb = argv[1];
    task.format = argv[2];
    return true;
}

int print_version(const char* version) {
    const bool restricted = restrict_files();
    const bool filtered = filter_calls();
    std::printf("%s, files %s, system calls %s\n", version, restricted ? "restricted" : "not restricted",
                filtered ? "filtered" : "not filtered");
    return std::fflush(stdout) == 0 ? 0 : 1;
}

}  // namespace

int run_program(const char* name, const char* version, int argc, char** argv, Work work) {
    if (argc == 2 && std::string_view(argv[1]) == "--version") _exit(print_version(version));
    Task task;
    if (!parse_task(argc, argv, task)) {
        static_cast<void>(std::fprintf(stderr, "%s: started by libtex, not by hand\n", name));
        return 2;
    }
    run_task(task, work);
    // Without destructors: those of large libraries take a tenth of a second, and need calls that are filtered.
    _exit(0);
}

bool write_result(std::uint64_t offset, const void* data, std::uint64_t count) {
    const auto* from = static_cast<const char*>(data);
    while (count > 0) {
        const ssize_t n = pwrite(kResultDescriptor, from, count, static_cast<off_t>(offset));
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) return false;
        from += n;
        offset += static_cast<std::uint64_t>(n);
        count -= static_cast<std::uint64_t>(n);
    }
    return true;
}

void put_progress() {
    const char strip = 0;
    if (write(kProgressDescriptor, &strip, 1) != 1) _exit(1);  // the parent has ended
}

bool has_room_for_a_thread() {
    constexpr std::size_t kStack = std::size_t{9} << 20;
    void* const stack = mmap(nullptr, kStack, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (stack == MAP_FAILED) return false;
    munmap(stack, kStack);
    return true;
}

void leave(int status) { _exit(status); }

void reserve_result(std::uint64_t bytes) {
    if (mmap(nullptr, bytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0) == MAP_FAILED)
        throw std::bad_alloc();
}

bool read_input(std::uint64_t offset, void* to, std::uint64_t count) {
    auto* at = static_cast<char*>(to);
    while (count > 0) {
        const ssize_t n = pread(kInputDescriptor, at, count, static_cast<off_t>(offset));
        if (n <= 0) return false;
        at += n;
        offset += static_cast<std::uint64_t>(n);
        count -= static_cast<std::uint64_t>(n);
    }
    return true;
}

}  // namespace tex::reader
