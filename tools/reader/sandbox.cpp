// SPDX-License-Identifier: Apache-2.0

#include <fcntl.h>
#include <linux/landlock.h>
#include <sched.h>
#include <seccomp.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <limits>

#include "reader.h"

// Sanitizers map terabytes of shadow, and look at memory through pipes: under them the address space stays unlimited
// and pipes are allowed.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define TEX_READER_SHADOW 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || __has_feature(memory_sanitizer)
#define TEX_READER_SHADOW 1
#endif
#endif

namespace tex::reader {
namespace {

void limit(__rlimit_resource what, std::int64_t value) {
    rlimit now{};
    if (getrlimit(what, &now) != 0) return;
    const auto wanted = static_cast<rlim_t>(value);
    const rlim_t at_most = now.rlim_max < wanted ? now.rlim_max : wanted;
    const rlimit limits{at_most, at_most};
    setrlimit(what, &limits);
}

// What decoders, the C library, the loader and threads call. Everything else fails with EPERM.
constexpr int kAllowed[] = {
    // reading and writing what is open, and the result
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
    SCMP_SYS(fcntl),
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
    // threads and signals of this process
    SCMP_SYS(futex),
    SCMP_SYS(set_robust_list),
    SCMP_SYS(rseq),
    SCMP_SYS(sched_yield),
    SCMP_SYS(sched_getaffinity),
    SCMP_SYS(sched_setaffinity),
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
    // clocks and facts
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

bool rule(scmp_filter_ctx filter, std::uint32_t action, int call, scmp_arg_cmp condition) {
    return seccomp_rule_add_array(filter, action, call, 1, &condition) == 0;
}

// Opening for reading only, reading limits only, threads only, and signals to this process only; glibc falls back from
// clone3 (whose flags a filter cannot see) to clone.
bool allow_conditional(scmp_filter_ctx filter) {
    constexpr scmp_datum_t kWriting = O_WRONLY | O_RDWR | O_CREAT | O_TRUNC | O_APPEND;
    return rule(filter, SCMP_ACT_ALLOW, SCMP_SYS(open), {1, SCMP_CMP_MASKED_EQ, kWriting, 0}) &&
           rule(filter, SCMP_ACT_ALLOW, SCMP_SYS(openat), {2, SCMP_CMP_MASKED_EQ, kWriting, 0}) &&
           rule(filter, SCMP_ACT_ALLOW, SCMP_SYS(prlimit64), {2, SCMP_CMP_EQ, 0, 0}) &&
           rule(filter, SCMP_ACT_ALLOW, SCMP_SYS(tgkill), {0, SCMP_CMP_EQ, static_cast<scmp_datum_t>(getpid()), 0}) &&
           rule(filter, SCMP_ACT_ALLOW, SCMP_SYS(clone), {0, SCMP_CMP_MASKED_EQ, CLONE_THREAD, CLONE_THREAD}) &&
           seccomp_rule_add(filter, SCMP_ACT_ERRNO(ENOSYS), SCMP_SYS(clone3), 0) == 0 &&
           seccomp_rule_add(filter, SCMP_ACT_ERRNO(ENOSYS), SCMP_SYS(openat2), 0) == 0;
}

}  // namespace

void limit_process(const Task& task) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != task.parent) _exit(1);  // it was gone before
    constexpr int kDescriptors = 64;
#ifndef TEX_READER_SHADOW
    limit(RLIMIT_AS, task.memory);
#endif
    limit(RLIMIT_FSIZE, task.memory);
    limit(RLIMIT_CPU, task.seconds + 1);
    limit(RLIMIT_CORE, 0);
    limit(RLIMIT_NOFILE, kDescriptors);
}

std::int64_t memory_limit() {
    auto most = static_cast<rlim_t>(std::numeric_limits<std::int64_t>::max());
    for (const auto what : {RLIMIT_AS, RLIMIT_FSIZE}) {
        rlimit now{};
        if (getrlimit(what, &now) == 0) most = std::min(most, now.rlim_cur);
    }
    return static_cast<std::int64_t>(most);
}

int landlock_version() {
    const long version = syscall(SYS_landlock_create_ruleset, nullptr, 0L, LANDLOCK_CREATE_RULESET_VERSION);
    return version < 1 ? 0 : static_cast<int>(version);
}

bool restrict_files() {
    // What the first version of Landlock knows (Linux 5.13), and from its second and third on renames across folders
    // and truncation.
    constexpr std::uint64_t kFirst = (std::uint64_t{1} << 13) - 1;
    const int version = landlock_version();
    if (version < 1) return false;
    landlock_ruleset_attr attributes{};
    attributes.handled_access_fs =
        kFirst | (version >= 2 ? std::uint64_t{1} << 13 : 0) | (version >= 3 ? std::uint64_t{1} << 14 : 0);
    const auto rules = static_cast<int>(syscall(SYS_landlock_create_ruleset, &attributes, sizeof attributes, 0));
    if (rules < 0) return false;
    // Decoders open their input by its name in /proc. Files in memory cannot be named in a rule, and need none;
    // `tex-reader --version` has no input.
    landlock_path_beneath_attr input{};
    input.allowed_access = LANDLOCK_ACCESS_FS_READ_FILE;
    input.parent_fd = kInputDescriptor;
    const bool named = syscall(SYS_landlock_add_rule, rules, LANDLOCK_RULE_PATH_BENEATH, &input, 0) == 0 ||
                       errno == EBADFD || errno == EBADF;
    const bool done =
        named && prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 && syscall(SYS_landlock_restrict_self, rules, 0) == 0;
    close(rules);
    return done && open("/", O_RDONLY | O_DIRECTORY | O_CLOEXEC) < 0;
}

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
