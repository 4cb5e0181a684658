// SPDX-License-Identifier: Apache-2.0
// no_thread_memory.cpp: a library to preload. Only the main thread gets memory; in every other thread, the functions
// that allocate memory fail. So a thread of TBB fails where it starts, which is code that nobody can catch.

#include <cerrno>
#include <cstddef>

#include <sys/syscall.h>
#include <unistd.h>

namespace {

bool is_main_thread() { return syscall(SYS_gettid) == getpid(); }

}  // namespace

extern "C" {

void* __libc_malloc(std::size_t bytes);
void* __libc_memalign(std::size_t alignment, std::size_t bytes);

void* malloc(std::size_t bytes) noexcept {
    if (is_main_thread()) return __libc_malloc(bytes);
    errno = ENOMEM;
    return nullptr;
}

void* memalign(std::size_t alignment, std::size_t bytes) noexcept {
    if (is_main_thread()) return __libc_memalign(alignment, bytes);
    errno = ENOMEM;
    return nullptr;
}

void* aligned_alloc(std::size_t alignment, std::size_t bytes) noexcept { return memalign(alignment, bytes); }

int posix_memalign(void** memory, std::size_t alignment, std::size_t bytes) noexcept {
    *memory = memalign(alignment, bytes);
    return *memory == nullptr ? ENOMEM : 0;
}

}  // extern "C"
