// SPDX-License-Identifier: Apache-2.0

#include <cerrno>
#include <cstring>
#include <string_view>

#include <malloc.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "cli/exit_code.h"
#include "cli/process_posix.h"

namespace tex::cli {
namespace {

// Checks that the process can get any memory at all, and prints an error if it cannot. It must run before the
// constructors of the libraries, which call abort() if they get no memory. It must also run before the standard library
// reserves memory for exceptions; without that memory, throwing an exception calls abort(), too.
void check_memory(int, char** argv, char**) {
    constexpr std::string_view kOutOfMemory = ": error: out of memory\n";
    constexpr std::size_t kStart = std::size_t{4} << 20;
    // A direct system call: libraries that intercept functions of the C library are not ready yet.
    const long memory = syscall(SYS_mmap, 0L, kStart, long{PROT_NONE}, long{MAP_PRIVATE | MAP_ANONYMOUS}, -1L, 0L);
    if (memory != -1) {
        syscall(SYS_munmap, memory, kStart);
        return;
    }
    const char* const slash = std::strrchr(argv[0], '/');
    for (const std::string_view text : {std::string_view(slash == nullptr ? argv[0] : slash + 1), kOutOfMemory}) {
        [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, text.data(), text.size());
    }
    _exit(static_cast<int>(ExitCode::io));
}
[[gnu::section(".preinit_array"), gnu::used]] void (*const g_check_memory)(int, char**, char**) = check_memory;

}  // namespace

const char* program_name() { return program_invocation_short_name; }

void keep_freed_memory() {
#ifdef __GLIBC__
    // Blocks of more than 32 MB would go back to the system whatever their threshold is, and each page of the next one
    // would be cleared again: a quarter of the time of repair-normals with 4096x4096 texels.
    constexpr int kKept = 1 << 30;
    mallopt(M_TRIM_THRESHOLD, kKept);
    mallopt(M_MMAP_MAX, 0);
#endif
}

}  // namespace tex::cli
