// SPDX-License-Identifier: Apache-2.0
// What tex-reader gives up before it looks at a file, tried from inside: in a process of its own, which then tells what
// it could still do.

#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "reader.h"

namespace tex::reader {
namespace {

// What is tried, and whether that was possible.
struct Attempt {
    const char* name;
    std::function<bool()> succeeds;
};

long open_with(const std::string& path, int flags) { return syscall(SYS_openat, AT_FDCWD, path.c_str(), flags, 0600); }

// The names of the attempts that succeed after `prepare`, in a process of its own.
std::string possible(const std::function<bool()>& prepare, const std::vector<Attempt>& attempts) {
    int ends[2];
    if (pipe(ends) != 0) return "no pipe";
    constexpr int kOutOfTheWay = 64;  // of kInputDescriptor
    for (int& end : ends) {
        const int low = std::exchange(end, fcntl(end, F_DUPFD, kOutOfTheWay));
        close(low);
    }
    const pid_t child = fork();
    if (child == 0) {
        if (!prepare()) _exit(7);
        for (const Attempt& attempt : attempts) {
            if (!attempt.succeeds()) continue;
            const std::string line = std::string(attempt.name) + "\n";
            if (write(ends[1], line.data(), line.size()) < 0) _exit(8);
        }
        _exit(0);
    }
    close(ends[1]);
    std::string text;
    char buffer[1000];
    for (ssize_t n = 0; (n = read(ends[0], buffer, sizeof buffer)) > 0;)
        text.append(buffer, static_cast<std::size_t>(n));
    close(ends[0]);
    int status = 0;
    waitpid(child, &status, 0);
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) text += "ended with status " + std::to_string(status);
    return text;
}

class Sandbox : public testing::Test {
protected:
    void SetUp() override {
        std::string pattern = testing::TempDir() + "sandbox_XXXXXX";
        ASSERT_NE(mkdtemp(pattern.data()), nullptr);
        folder_ = pattern;
        std::ofstream(file_ = folder_ + "/file") << "text";
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    // All of them must be possible without the sandbox, or the test proves nothing. (Not all are for everybody
    // everywhere: `certain` ones are.)
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
        if (certain) return all;
        all.push_back({"trace the parent", [=] { return syscall(SYS_ptrace, 16, parent, nullptr, nullptr) == 0; }});
        all.push_back({"handle of the parent", [=] { return syscall(SYS_pidfd_open, parent, 0) >= 0; }});
        all.push_back(
            {"mount", [=, this] { return syscall(SYS_mount, "none", folder_.c_str(), "tmpfs", 0, nullptr) == 0; }});
        all.push_back({"another program", [] {
                           const char* const words[] = {"/bin/true", nullptr};
                           return syscall(SYS_execve, words[0], words, nullptr) ==
                                  0;  // does not come back: status 0, and what follows is missing
                       }});
        all.push_back({"the end", [] { return true; }});
        return all;
    }

    std::string folder_, file_;
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
    };
    EXPECT_EQ(possible(filter_calls, work), "signal to itself\nmemory\nread\n");
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

}  // namespace
}  // namespace tex::reader
