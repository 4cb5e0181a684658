// SPDX-License-Identifier: Apache-2.0

#include <fcntl.h>
#include <sched.h>
#include <seccomp.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <initializer_list>

#include "reader.h"

namespace tex::reader {
namespace {

// The calls that decoders, the C library, the loader and threads make. Every other call fails with EPERM.
constexpr int kAllowed[] = {
    // reads and writes of open files, and the result
    SCMP_SYS(read),
    SCMP_SYS(pread64),
    SCMP_SYS(readv),
    SCMP_SYS(write),
    SCMP_SYS(pwrite64),
    SCMP_SYS(writev),
    SCMP_SYS(lseek),
    SCMP_SYS(close),
    SCMP_SYS(fstat),
    SCMP_SYS(stat),
    SCMP_SYS(lstat),
    SCMP_SYS(newfstatat),
    SCMP_SYS(statx),
    SCMP_SYS(access),
    SCMP_SYS(faccessat),
    SCMP_SYS(readlink),
    SCMP_SYS(readlinkat),
    SCMP_SYS(getcwd),
    SCMP_SYS(dup),
    SCMP_SYS(ftruncate),
    SCMP_SYS(fadvise64),
    SCMP_SYS(poll),
    SCMP_SYS(getdents64),
    // memory
    SCMP_SYS(mmap),
    SCMP_SYS(munmap),
    SCMP_SYS(mprotect),
    SCMP_SYS(mremap),
    SCMP_SYS(madvise),
    SCMP_SYS(brk),
    // threads of this process, and signals to it
    SCMP_SYS(futex),
    SCMP_SYS(set_robust_list),
    SCMP_SYS(rseq),
    SCMP_SYS(sched_yield),
    SCMP_SYS(gettid),
    SCMP_SYS(getpid),
    SCMP_SYS(rt_sigaction),
    SCMP_SYS(rt_sigprocmask),
    SCMP_SYS(rt_sigreturn),
    SCMP_SYS(sigaltstack),
    SCMP_SYS(membarrier),
    SCMP_SYS(arch_prctl),
    SCMP_SYS(exit),
    SCMP_SYS(exit_group),
    SCMP_SYS(restart_syscall),
    // clocks and system information
    SCMP_SYS(clock_gettime),
    SCMP_SYS(clock_getres),
    SCMP_SYS(clock_nanosleep),
    SCMP_SYS(nanosleep),
    SCMP_SYS(gettimeofday),
    SCMP_SYS(time),
    SCMP_SYS(getrandom),
    SCMP_SYS(uname),
    SCMP_SYS(sysinfo),
    SCMP_SYS(getrlimit),
#ifdef TEX_READER_SHADOW
    SCMP_SYS(pipe),
    SCMP_SYS(pipe2),
#endif
    SCMP_SYS(getrusage),
    SCMP_SYS(getuid),
    SCMP_SYS(geteuid),
    SCMP_SYS(getgid),
    SCMP_SYS(getegid),
    SCMP_SYS(getcpu),
};

bool allow(scmp_filter_ctx filter, int call, std::initializer_list<scmp_arg_cmp> conditions) {
    return seccomp_rule_add_array(filter, SCMP_ACT_ALLOW, call, static_cast<unsigned>(conditions.size()),
                                  conditions.begin()) == 0;
}

// Calls that, depending on their arguments, can reach beyond this process or ask for more than is needed:
// * files are opened for reading only;
// * the flags of a descriptor may be read, but no other command of fcntl() is allowed: others make the kernel send
//   signals to any process of this user (F_SETOWN, F_SETSIG, O_ASYNC), delay anyone who opens a file (F_SETLEASE,
//   F_SETLK), or take memory that no limit counts (F_SETPIPE_SZ);
// * limits are read, and processors chosen, for this process only (0);
// * signals go to this process only;
// * a new process must be a thread; glibc falls back from clone3, whose flags a filter cannot see, to clone.
bool allow_conditional(scmp_filter_ctx filter) {
    constexpr scmp_datum_t kWriting = O_WRONLY | O_RDWR | O_CREAT | O_TRUNC | O_APPEND;
    const auto self = static_cast<scmp_datum_t>(getpid());
    return allow(filter, SCMP_SYS(open), {{1, SCMP_CMP_MASKED_EQ, kWriting, 0}}) &&
           allow(filter, SCMP_SYS(openat), {{2, SCMP_CMP_MASKED_EQ, kWriting, 0}}) &&
           allow(filter, SCMP_SYS(fcntl), {{1, SCMP_CMP_EQ, F_GETFD, 0}}) &&
           allow(filter, SCMP_SYS(fcntl), {{1, SCMP_CMP_EQ, F_GETFL, 0}}) &&
           allow(filter, SCMP_SYS(prlimit64), {{0, SCMP_CMP_EQ, 0, 0}, {2, SCMP_CMP_EQ, 0, 0}}) &&
           allow(filter, SCMP_SYS(sched_setaffinity), {{0, SCMP_CMP_EQ, 0, 0}}) &&
#ifdef TEX_READER_SHADOW  // whose runtime asks for its threads by their numbers
           allow(filter, SCMP_SYS(sched_getaffinity), {}) &&
#else
           allow(filter, SCMP_SYS(sched_getaffinity), {{0, SCMP_CMP_EQ, 0, 0}}) &&
#endif
           allow(filter, SCMP_SYS(tgkill), {{0, SCMP_CMP_EQ, self, 0}}) &&
           allow(filter, SCMP_SYS(clone), {{0, SCMP_CMP_MASKED_EQ, CLONE_THREAD, CLONE_THREAD}}) &&
           seccomp_rule_add(filter, SCMP_ACT_ERRNO(ENOSYS), SCMP_SYS(clone3), 0) == 0 &&
           seccomp_rule_add(filter, SCMP_ACT_ERRNO(ENOSYS), SCMP_SYS(openat2), 0) == 0;
}

}  // namespace

void end_with_parent() { prctl(PR_SET_PDEATHSIG, SIGKILL); }

bool filter_calls() {
    scmp_filter_ctx filter = seccomp_init(SCMP_ACT_ERRNO(EPERM));
    if (filter == nullptr) return false;
    bool sound = seccomp_attr_set(filter, SCMP_FLTATR_CTL_TSYNC, 1) == 0;
    for (const int call : kAllowed) sound = sound && seccomp_rule_add(filter, SCMP_ACT_ALLOW, call, 0) == 0;
    sound = sound && allow_conditional(filter) && seccomp_load(filter) == 0;
    seccomp_release(filter);
    return sound;
}

}  // namespace tex::reader
