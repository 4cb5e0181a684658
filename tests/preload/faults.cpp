// SPDX-License-Identifier: Apache-2.0
// faults: loaded before a command (LD_PRELOAD), makes one of its system calls fail, or the last thing that it does.
// Variables of the environment:
//
//     TEX_FAULT_COUNT=FILE     where calls are counted: 4 bytes, which the test makes and reads afterwards
//     TEX_FAULT_AT=N           the call that fails, counted from 1; without it none does
//     TEX_FAULT_ERRNO=E        with this error (EIO)
//     TEX_FAULT_KILL=1         SIGKILL instead
//     TEX_FAULT_SHORTEN=FILE   instead, FILE loses its second half before the call
//     TEX_FAULT_REPLACE=FILE   instead, the file TEX_FAULT_BY takes the name of FILE before the call
//     TEX_FAULT_FULL=N         the disk is full after N calls of pwrite(): all others find no space
//     TEX_FAULT_NO_TMPFILE=1   the file system has no nameless files
//     TEX_FAULT_THREADS=N      only the first N threads can be started
//
// Calls that the C library makes for itself are not seen, and, of oneTBB 2022, not those of its allocator. Processes
// that the command starts have an empty environment: they are left alone.

#include <dlfcn.h>
#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <tbb/version.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdarg>
#include <cstdlib>
#include <cstring>
#include <type_traits>

namespace {

struct Plan {
    int at = 0;
    int error = EIO;
    bool kill = false;
    bool no_tmpfile = false;
    int threads = -1;  // any number
    int full = -1;     // never
    const char* shorten = nullptr;
    const char* replace = nullptr;
    const char* by = nullptr;
    std::atomic<int>* calls = nullptr;
};

int number(const char* name, int otherwise) {
    const char* text = getenv(name);
    return text == nullptr ? otherwise : atoi(text);
}

// syscall() takes registers: an int must not come with whatever the upper half of one held.
template <class T>
auto wide(T argument) {
    if constexpr (std::is_integral_v<T>)
        return static_cast<long>(argument);
    else
        return argument;
}

template <class... Arguments>
long wide_syscall(long which, Arguments... arguments) {
    return syscall(which, wide(arguments)...);
}

Plan make_plan() {
    Plan plan;
    plan.at = number("TEX_FAULT_AT", 0);
    plan.error = number("TEX_FAULT_ERRNO", EIO);
    plan.kill = number("TEX_FAULT_KILL", 0) != 0;
    plan.no_tmpfile = number("TEX_FAULT_NO_TMPFILE", 0) != 0;
    plan.threads = number("TEX_FAULT_THREADS", -1);
    plan.full = number("TEX_FAULT_FULL", -1);
    plan.shorten = getenv("TEX_FAULT_SHORTEN");
    plan.replace = getenv("TEX_FAULT_REPLACE");
    plan.by = getenv("TEX_FAULT_BY");
    if (const char* file = getenv("TEX_FAULT_COUNT")) {
        const auto fd = static_cast<int>(wide_syscall(SYS_openat, AT_FDCWD, file, O_RDWR | O_CLOEXEC));
        const long place = wide_syscall(SYS_mmap, nullptr, sizeof(int), PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
        if (fd >= 0 && place != -1) plan.calls = reinterpret_cast<std::atomic<int>*>(place);
        if (fd >= 0) wide_syscall(SYS_close, fd);
    }
    return plan;
}

const Plan& plan() {
    static const Plan made = make_plan();
    return made;
}

// Before main(): a static inside a function may call what is defined below.
[[gnu::constructor]] void prepare() { static_cast<void>(plan()); }

// Whether this call fails.
bool fails() {
    if (plan().calls == nullptr || ++*plan().calls != plan().at) return false;
    if (plan().kill) {
        kill(getpid(), SIGKILL);
        for (;;) pause();
    }
    if (plan().shorten != nullptr) {
        struct stat status {};
        if (stat(plan().shorten, &status) == 0) wide_syscall(SYS_truncate, plan().shorten, status.st_size / 2);
        return false;
    }
    if (plan().replace != nullptr) {
        wide_syscall(SYS_renameat2, AT_FDCWD, plan().by, AT_FDCWD, plan().replace, 0);
        return false;
    }
    errno = plan().error;
    return true;
}

// oneTBB 2022 cannot stand an allocator without memory while the first arena starts:
// threading_control::create_threading_control() (threading_control.cpp:215) takes the locks of all global controls, an
// allocation under them (line 223 or 224) fails, and before it throws, do_throw() (exception.cpp) asks
// terminate_on_exception(), which takes one of these locks again and waits for ever in sched_yield(). A program that
// holds nothing but an arena does the same. So the calls of its allocator do not fail there.
bool waits_for_ever(const void* caller) {
    Dl_info about{};
    return TBB_VERSION_MAJOR >= 2022 && dladdr(caller, &about) != 0 && about.dli_fname != nullptr &&
           strstr(about.dli_fname, "libtbbmalloc") != nullptr;
}

template <class... Arguments>
long call(long which, Arguments... arguments) {
    return fails() ? -1 : wide_syscall(which, arguments...);
}

int open_file(int folder, const char* path, int flags, mode_t mode) {
    if (plan().no_tmpfile && (flags & __O_TMPFILE) == __O_TMPFILE) {  // which has O_DIRECTORY in it
        errno = EOPNOTSUPP;
        return -1;
    }
    return static_cast<int>(call(SYS_openat, folder, path, flags, mode));
}

long write_at(int fd, const void* data, size_t count, off_t at) {
    static std::atomic<int> written{0};
    if (plan().full >= 0 && written++ >= plan().full) {
        errno = ENOSPC;
        return -1;
    }
    return call(SYS_pwrite64, fd, data, count, at);
}

mode_t mode_of(int flags, va_list list) {
    return (flags & O_CREAT) != 0 || (flags & __O_TMPFILE) == __O_TMPFILE ? va_arg(list, mode_t) : 0;
}

}  // namespace

// Under names of their own here: headers declare some of them otherwise.
#define TEX_CALL(result, name, ...)                           \
    extern "C" result tex_##name(__VA_ARGS__) __asm__(#name); \
    extern "C" result tex_##name(__VA_ARGS__)

#define TEX_OPEN(name)                                      \
    TEX_CALL(int, name, const char* path, int flags, ...) { \
        va_list list;                                       \
        va_start(list, flags);                              \
        const mode_t mode = mode_of(flags, list);           \
        va_end(list);                                       \
        return open_file(AT_FDCWD, path, flags, mode);      \
    }
#define TEX_OPENAT(name)                                                \
    TEX_CALL(int, name, int folder, const char* path, int flags, ...) { \
        va_list list;                                                   \
        va_start(list, flags);                                          \
        const mode_t mode = mode_of(flags, list);                       \
        va_end(list);                                                   \
        return open_file(folder, path, flags, mode);                    \
    }

TEX_OPEN(open)
TEX_OPEN(open64)
TEX_OPENAT(openat)
TEX_OPENAT(openat64)
TEX_CALL(int, __open_2, const char* path, int flags) { return open_file(AT_FDCWD, path, flags, 0); }
TEX_CALL(int, __open64_2, const char* path, int flags) { return open_file(AT_FDCWD, path, flags, 0); }
TEX_CALL(int, __openat_2, int folder, const char* path, int flags) { return open_file(folder, path, flags, 0); }
TEX_CALL(int, __openat64_2, int folder, const char* path, int flags) { return open_file(folder, path, flags, 0); }

TEX_CALL(ssize_t, read, int fd, void* data, size_t count) { return call(SYS_read, fd, data, count); }
TEX_CALL(ssize_t, __read_chk, int fd, void* data, size_t count, size_t) { return call(SYS_read, fd, data, count); }
TEX_CALL(ssize_t, pread, int fd, void* data, size_t count, off_t at) { return call(SYS_pread64, fd, data, count, at); }
TEX_CALL(ssize_t, pread64, int fd, void* data, size_t count, off_t at) {
    return call(SYS_pread64, fd, data, count, at);
}
TEX_CALL(ssize_t, __pread_chk, int fd, void* data, size_t count, off_t at, size_t) {
    return call(SYS_pread64, fd, data, count, at);
}
TEX_CALL(ssize_t, __pread64_chk, int fd, void* data, size_t count, off_t at, size_t) {
    return call(SYS_pread64, fd, data, count, at);
}
TEX_CALL(ssize_t, write, int fd, const void* data, size_t count) { return call(SYS_write, fd, data, count); }
TEX_CALL(ssize_t, pwrite, int fd, const void* data, size_t count, off_t at) { return write_at(fd, data, count, at); }
TEX_CALL(ssize_t, pwrite64, int fd, const void* data, size_t count, off_t at) { return write_at(fd, data, count, at); }

TEX_CALL(int, ftruncate, int fd, off_t size) { return static_cast<int>(call(SYS_ftruncate, fd, size)); }
TEX_CALL(int, ftruncate64, int fd, off_t size) { return static_cast<int>(call(SYS_ftruncate, fd, size)); }
TEX_CALL(int, fallocate, int fd, int mode, off_t at, off_t size) {
    return static_cast<int>(call(SYS_fallocate, fd, mode, at, size));
}
TEX_CALL(int, posix_fallocate, int fd, off_t at, off_t size) {
    return call(SYS_fallocate, fd, 0, at, size) == 0 ? 0 : errno;
}
TEX_CALL(int, fsync, int fd) { return static_cast<int>(call(SYS_fsync, fd)); }
TEX_CALL(int, fdatasync, int fd) { return static_cast<int>(call(SYS_fdatasync, fd)); }
TEX_CALL(int, fchmod, int fd, mode_t mode) { return static_cast<int>(call(SYS_fchmod, fd, mode)); }
TEX_CALL(int, flock, int fd, int operation) { return static_cast<int>(call(SYS_flock, fd, operation)); }
TEX_CALL(int, mkdir, const char* path, mode_t mode) { return static_cast<int>(call(SYS_mkdir, path, mode)); }
TEX_CALL(int, linkat, int from_folder, const char* from, int to_folder, const char* to, int flags) {
    return static_cast<int>(call(SYS_linkat, from_folder, from, to_folder, to, flags));
}
TEX_CALL(int, rename, const char* from, const char* to) { return static_cast<int>(call(SYS_rename, from, to)); }
TEX_CALL(int, renameat, int from_folder, const char* from, int to_folder, const char* to) {
    return static_cast<int>(call(SYS_renameat2, from_folder, from, to_folder, to, 0u));
}
TEX_CALL(int, renameat2, int from_folder, const char* from, int to_folder, const char* to, unsigned flags) {
    return static_cast<int>(call(SYS_renameat2, from_folder, from, to_folder, to, flags));
}
TEX_CALL(int, memfd_create, const char* name, unsigned flags) {
    return static_cast<int>(call(SYS_memfd_create, name, flags));
}
TEX_CALL(int, pipe2, int* ends, int flags) { return static_cast<int>(call(SYS_pipe2, ends, flags)); }

TEX_CALL(void*, mmap, void* at, size_t size, int protection, int flags, int fd, off_t offset) {
    return !waits_for_ever(__builtin_return_address(0)) && fails()
               ? MAP_FAILED
               : reinterpret_cast<void*>(wide_syscall(SYS_mmap, at, size, protection, flags, fd, offset));
}
TEX_CALL(void*, mmap64, void* at, size_t size, int protection, int flags, int fd, off_t offset) {
    return !waits_for_ever(__builtin_return_address(0)) && fails()
               ? MAP_FAILED
               : reinterpret_cast<void*>(wide_syscall(SYS_mmap, at, size, protection, flags, fd, offset));
}

TEX_CALL(int, posix_spawn, pid_t* child, const char* path, const posix_spawn_file_actions_t* actions,
         const posix_spawnattr_t* attributes, char* const* argv, char* const* environment) {
    if (fails()) return errno;
    static const auto real = reinterpret_cast<decltype(&posix_spawn)>(dlsym(RTLD_NEXT, "posix_spawn"));
    return real(child, path, actions, attributes, argv, environment);
}

TEX_CALL(int, pthread_create, pthread_t* thread, const pthread_attr_t* attributes, void* (*body)(void*),
         void* argument) {
    static std::atomic<int> started{0};
    if (plan().threads >= 0 && started++ >= plan().threads) return EAGAIN;
    static const auto real = reinterpret_cast<decltype(&pthread_create)>(dlsym(RTLD_NEXT, "pthread_create"));
    return real(thread, attributes, body, argument);
}
