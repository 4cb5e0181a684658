// SPDX-License-Identifier: Apache-2.0
// Tries, from inside, the rights that tex-reader gives up before it looks at a file. The attempts run in a separate
// process, which then reports what it can still do.

#include <asm/ioctls.h>
#include <fcntl.h>
#include <sched.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "reader.h"
#include "scratch.h"
#include "unit/child_text.h"

namespace tex::reader {
namespace {

// An attempted action, and whether it succeeds.
struct Attempt {
    const char* name;
    std::function<bool()> succeeds;
};

long open_with(const std::string& path, int flags) { return syscall(SYS_openat, AT_FDCWD, path.c_str(), flags, 0600); }

bool queue_signal(pid_t process) {
    siginfo_t info{};
    info.si_code = SI_QUEUE;
    return syscall(SYS_rt_sigqueueinfo, process, 0, &info) == 0;
}

// The names of the attempts that succeed after `prepare`, in a separate process.
std::string possible(const std::function<bool()>& prepare, const std::vector<Attempt>& attempts) {
    return child_text([&](int out) {
        if (!prepare()) return 7;
        for (const Attempt& attempt : attempts) {
            if (!attempt.succeeds()) continue;
            const std::string line = std::string(attempt.name) + "\n";
            if (write(out, line.data(), line.size()) < 0) return 8;
        }
        return 0;
    });
}

class Sandbox : public testing::Test, protected Scratch {
protected:
    void SetUp() override {
        std::ofstream(file_ = folder_ + "/file") << "text";
        ASSERT_EQ(pipe(pipe_), 0);
        std::ofstream(folder_ + "/nameless") << "text";  // a lease needs a file that nobody has open for writing
        opened_ = open((folder_ + "/nameless").c_str(), O_RDONLY);
        std::filesystem::remove(folder_ + "/nameless");
        opened_folder_ = open(folder_.c_str(), O_RDONLY | O_DIRECTORY);
        memory_ = memfd_create("memory", MFD_ALLOW_SEALING);
    }
    void TearDown() override {
        for (const int fd : {pipe_[0], pipe_[1], opened_, opened_folder_, memory_}) close(fd);
    }

    // All of them must be possible without the sandbox, or the test proves nothing. (Some are not possible for every
    // user or on every system; the `certain` ones are.)
    [[nodiscard]] std::vector<Attempt> attempts(bool certain) const {
        const pid_t parent = getpid();
        const auto path = [this](const char* name) { return folder_ + "/" + name; };
        std::vector<Attempt> all = {
            {"open to write", [=, this] { return open_with(file_, O_WRONLY) >= 0; }},
            {"open to read and write", [=, this] { return open_with(file_, O_RDWR) >= 0; }},
            {"open to append", [=, this] { return open_with(file_, O_WRONLY | O_APPEND) >= 0; }},
            {"create", [=] { return open_with(path("new"), O_RDONLY | O_CREAT) >= 0; }},
            {"empty", [=, this] { return open_with(file_, O_RDONLY | O_TRUNC) >= 0; }},
            {"link",
             [=, this] {
                 return syscall(SYS_linkat, AT_FDCWD, file_.c_str(), AT_FDCWD, path("link").c_str(), 0) == 0;
             }},
            {"symbolic link",
             [=, this] { return syscall(SYS_symlinkat, file_.c_str(), AT_FDCWD, path("symbolic").c_str()) == 0; }},
            {"rename",
             [=] {
                 return syscall(SYS_renameat2, AT_FDCWD, path("link").c_str(), AT_FDCWD, path("other").c_str(), 0) == 0;
             }},
            {"folder", [=] { return syscall(SYS_mkdirat, AT_FDCWD, path("folder").c_str(), 0700) == 0; }},
            {"mode", [=, this] { return syscall(SYS_fchmodat, AT_FDCWD, file_.c_str(), 0600) == 0; }},
            {"truncate", [=, this] { return syscall(SYS_truncate, file_.c_str(), 1) == 0; }},
            {"remove", [=] { return syscall(SYS_unlinkat, AT_FDCWD, path("symbolic").c_str(), 0) == 0; }},
            {"local socket", [] { return syscall(SYS_socket, AF_UNIX, SOCK_STREAM, 0) >= 0; }},
            {"internet socket", [] { return syscall(SYS_socket, AF_INET, SOCK_STREAM, 0) >= 0; }},
            {"datagrams", [] { return syscall(SYS_socket, AF_INET, SOCK_DGRAM, 0) >= 0; }},
            {"signal to the parent", [=] { return syscall(SYS_kill, parent, 0) == 0; }},
            {"signal to a thread of the parent", [=] { return syscall(SYS_tgkill, parent, parent, 0) == 0; }},
            {"queued signal to the parent", [=] { return queue_signal(parent); }},
            {"file in memory", [] { return syscall(SYS_memfd_create, "x", 0) >= 0; }},
            {"own limits",
             [] {
                 const rlimit core{};
                 return syscall(SYS_prlimit64, 0, RLIMIT_CORE, &core, nullptr) == 0;
             }},
            {"another process",
             [] {
                 const long child = syscall(SYS_clone, SIGCHLD, nullptr, nullptr, nullptr, nullptr);
                 if (child == 0) _exit(0);
                 return child > 0;
             }},
        };
        const std::vector<Attempt> more = attempts_by_descriptors(parent);
        all.insert(all.end(), more.begin(), more.end());
        const std::vector<Attempt> others = attempts_on_the_parent(parent);
        all.insert(all.end(), others.begin(), others.end());
        if (certain) return all;
        all.push_back({"size of a pipe", [this] { return fcntl(pipe_[0], F_SETPIPE_SZ, 1 << 17) > 0; }});
        all.push_back({"lease", [this] { return fcntl(opened_, F_SETLEASE, F_RDLCK) == 0; }});
        all.push_back({"notes of a folder", [this] { return fcntl(opened_folder_, F_NOTIFY, DN_CREATE) == 0; }});
        all.push_back({"memory of the parent", [=, this] {
                           char text[8];
                           const iovec here{text, 1}, there{const_cast<char*>(folder_.data()), 1};
                           return syscall(SYS_process_vm_readv, parent, &here, 1, &there, 1, 0) > 0;
                       }});
        all.push_back({"trace the parent", [=] { return syscall(SYS_ptrace, 16, parent, nullptr, nullptr) == 0; }});
        all.push_back({"handle of the parent", [=] { return syscall(SYS_pidfd_open, parent, 0) >= 0; }});
        all.push_back(
            {"mount", [=, this] { return syscall(SYS_mount, "none", folder_.c_str(), "tmpfs", 0, nullptr) == 0; }});
        all.push_back({"another program", [] {
                           const char* const words[] = {"/bin/true", nullptr};
                           return syscall(SYS_execve, words[0], words, nullptr) ==
                                  0;  // does not return: status 0, and the later attempts are missing
                       }});
        all.push_back({"the end", [] { return true; }});
        return all;
    }

    // The effects beyond this process that fcntl() and ioctl() can request from the kernel: signals to any process when
    // a pipe becomes readable, locks that other processes wait for, memory.
    [[nodiscard]] std::vector<Attempt> attempts_by_descriptors(pid_t parent) const {
        return {
            {"owner of signals", [=, this] { return fcntl(pipe_[0], F_SETOWN, parent) == 0; }},
            {"owner of signals, extended",
             [=, this] {
                 const f_owner_ex owner{F_OWNER_PID, parent};
                 return fcntl(pipe_[0], F_SETOWN_EX, &owner) == 0;
             }},
            {"signal of choice", [this] { return fcntl(pipe_[0], F_SETSIG, SIGWINCH) == 0; }},
            {"signals when readable", [this] { return fcntl(pipe_[0], F_SETFL, O_ASYNC) == 0; }},
            {"signals by ioctl",
             [this] {
                 const int on = 1;
                 return ioctl(pipe_[0], FIOASYNC, &on) == 0;
             }},
            {"lock",
             [this] {
                 const struct flock lock { F_RDLCK, SEEK_SET, 0, 0, 0 };
                 return fcntl(opened_, F_SETLK, &lock) == 0;
             }},
            {"whole lock", [this] { return flock(opened_, LOCK_SH) == 0; }},
            {"seal", [this] { return fcntl(memory_, F_ADD_SEALS, F_SEAL_WRITE) == 0; }},
            {"another number", [this] { return fcntl(opened_, F_DUPFD, 50) >= 0; }},
        };
    }

    // Calls that take a process id.
    [[nodiscard]] static std::vector<Attempt> attempts_on_the_parent(pid_t parent) {
        return {
            {"processors of the parent",
             [=] {
                 cpu_set_t set;
                 CPU_ZERO(&set);
                 for (int k = 0; k < CPU_SETSIZE; ++k) CPU_SET(k, &set);
                 return sched_setaffinity(parent, sizeof set, &set) == 0;
             }},
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // their runtimes ask it of other threads
                {"which are its processors",
                 [=] {
                     cpu_set_t set;
                     return syscall(SYS_sched_getaffinity, parent, sizeof set, &set) > 0;
                 }},
#endif
                {"limits of the parent",
                 [=] {
                     rlimit limit{};
                     return syscall(SYS_prlimit64, parent, RLIMIT_CORE, nullptr, &limit) == 0;
                 }},
                {"schedule of the parent",
                 [=] {
                     const sched_param none{};
                     return sched_setscheduler(parent, SCHED_OTHER, &none) == 0;
                 }},
                {"priority of the parent",
                 [=] { return setpriority(PRIO_PROCESS, static_cast<id_t>(parent), 19) == 0; }},
                {"session of the parent",  // 0 where its leader lives outside this namespace of processes
                 [=] { return syscall(SYS_getsid, parent) >= 0; }},
                {"survival of the parent", [] { return prctl(PR_SET_PDEATHSIG, 0) == 0; }},
        };
    }

    std::string file_;
    int pipe_[2] = {-1, -1};
    int opened_ = -1, opened_folder_ = -1, memory_ = -1;
};

TEST_F(Sandbox, NothingOfThisIsForbiddenOutside) {
    std::string all;
    for (const Attempt& attempt : attempts(true)) all += std::string(attempt.name) + "\n";
    EXPECT_EQ(possible([] { return true; }, attempts(true)), all);
}

TEST_F(Sandbox, HasNoNetworkNoWritingAndNoOtherProcesses) {
    EXPECT_EQ(possible(filter_calls, attempts(false)), "the end\n");
    EXPECT_EQ(std::filesystem::file_size(file_), 4u);
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_), {}), 1);
}

TEST_F(Sandbox, LetsADecoderDoItsWork) {
    const std::vector<Attempt> work = {
        {"signal to itself", [] { return syscall(SYS_tgkill, getpid(), syscall(SYS_gettid), 0) == 0; }},
        {"memory", [] { return syscall(SYS_mmap, nullptr, 4096L, 3L, 0x22L, -1L, 0L) != -1; }},
        {"read", [this] { return open_with(file_, O_RDONLY) >= 0; }},
        {"flags of a descriptor", [this] { return fcntl(opened_, F_GETFL) >= 0 && fcntl(opened_, F_GETFD) >= 0; }},
        {"own limits",
         [] {
             rlimit limit{};
             return getrlimit(RLIMIT_AS, &limit) == 0;
         }},
        {"own processors",
         [] {
             cpu_set_t set;
             return sched_getaffinity(0, sizeof set, &set) == 0 && sched_setaffinity(0, sizeof set, &set) == 0;
         }},
        {"a thread",
         [] {
             bool ran = false;
             std::thread([&] { ran = true; }).join();
             return ran;
         }},
    };
    EXPECT_EQ(possible(filter_calls, work),
              "signal to itself\nmemory\nread\nflags of a descriptor\nown limits\nown processors\na thread\n");
}

TEST_F(Sandbox, HasNoFilesButTheInput) {
    const std::vector<Attempt> reading = {
        {"input", [] { return open_with("/proc/self/fd/4", O_RDONLY) >= 0; }},
        {"file", [this] { return open_with(file_, O_RDONLY) >= 0; }},
        {"passwords", [] { return open_with("/etc/passwd", O_RDONLY) >= 0; }},
        {"folder", [this] { return open_with(folder_, O_RDONLY | O_DIRECTORY) >= 0; }}};
    std::ofstream(folder_ + "/input") << "text";
    const auto with_input = [this] {
        return dup2(open((folder_ + "/input").c_str(), O_RDONLY), kInputDescriptor) == kInputDescriptor;
    };
    EXPECT_EQ(possible(with_input, reading), "input\nfile\npasswords\nfolder\n");
    if (landlock_version() == 0) {
        EXPECT_FALSE(restrict_files()) << "and --version --json says so";
        return;
    }
    EXPECT_EQ(possible([&] { return with_input() && restrict_files(); }, reading), "input\n");
}

// The filter of calls is one reason why the process cannot send signals; Landlock is the other.
TEST_F(Sandbox, SendsNoSignalsWhereTheKernelCanScopeThem) {
    const pid_t parent = getpid();
    const std::vector<Attempt> signals = {{"to the parent", [=] { return kill(parent, 0) == 0; }},
                                          {"to itself", [] { return kill(getpid(), 0) == 0; }}};
    EXPECT_EQ(possible([] { return true; }, signals), "to the parent\nto itself\n");
    constexpr int kFirstWithScopes = 6;
    if (landlock_version() < kFirstWithScopes) return;
    EXPECT_EQ(possible(restrict_files, signals), "to itself\n");
}

}  // namespace
}  // namespace tex::reader
