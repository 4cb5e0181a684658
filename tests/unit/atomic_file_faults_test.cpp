// SPDX-License-Identifier: Apache-2.0
// Every system call of a write fails once, and once it is the last action of its process. This program defines the
// calls that write_file() makes. Its definitions take precedence over those of the C library.

#include <gtest/gtest.h>

#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdarg>
#include <filesystem>
#include <fstream>
#include <string>

#include <tex/file.h>

#include "scratch.h"
#include "unit/file_text.h"

namespace {

// The faults in the calls of this thread.
struct Faults {
    bool active = false;
    bool no_nameless = false;  // simulates a file system without O_TMPFILE
    bool dribble = false;      // makes writes interrupted and short
    bool kill = false;         // ends the process instead of failing
    int fail_at = 0;           // the call that fails, counted from 1; 0: none
    int error = EIO;
    int calls = 0;
    std::string order = {};  // w: bytes are written; s: they are flushed to the disk; n: the file gets a name
};
thread_local Faults faults;

// True if this call fails. `mark` represents it in Faults::order.
bool fails(const char* mark = "") {
    if (faults.active) faults.order += mark;
    if (!faults.active || ++faults.calls != faults.fail_at) return false;
    if (faults.kill) {
        kill(getpid(), SIGKILL);
        pause();
    }
    errno = faults.error;
    return true;
}

}  // namespace

extern "C" {

ssize_t pwrite(int fd, const void* data, std::size_t count, off_t offset) {
    if (faults.active && faults.dribble) {
        if (++faults.calls % 2 == 1) {
            errno = EINTR;
            return -1;
        }
        return syscall(SYS_pwrite64, fd, data, count > 7 ? 7 : count, offset);
    }
    return fails("w") ? -1 : syscall(SYS_pwrite64, fd, data, count, offset);
}

int openat(int folder, const char* path, int flags, ...) {
    va_list list;
    va_start(list, flags);
    const mode_t mode = (flags & O_CREAT) != 0 || (flags & __O_TMPFILE) == __O_TMPFILE ? va_arg(list, mode_t) : 0;
    va_end(list);
    if (faults.active && faults.no_nameless && (flags & __O_TMPFILE) == __O_TMPFILE) {  // it includes O_DIRECTORY
        errno = EOPNOTSUPP;
        return -1;
    }
    return fails() ? -1 : static_cast<int>(syscall(SYS_openat, folder, path, flags, mode));
}

int fdatasync(int fd) { return fails("s") ? -1 : static_cast<int>(syscall(SYS_fdatasync, fd)); }

// Has a different name here because <fcntl.h> has a struct flock.
int flock_call(int fd, int operation) noexcept __asm__("flock");
int flock_call(int fd, int operation) noexcept {
    return fails() ? -1 : static_cast<int>(syscall(SYS_flock, fd, operation));
}

int fchmod(int fd, mode_t mode) noexcept { return fails() ? -1 : static_cast<int>(syscall(SYS_fchmod, fd, mode)); }

int linkat(int from_folder, const char* from, int to_folder, const char* to, int flags) noexcept {
    return fails("n") ? -1 : static_cast<int>(syscall(SYS_linkat, from_folder, from, to_folder, to, flags));
}

int renameat(int from_folder, const char* from, int to_folder, const char* to) noexcept {
    return fails("n") ? -1 : static_cast<int>(syscall(SYS_renameat2, from_folder, from, to_folder, to, 0u));
}

int renameat2(int from_folder, const char* from, int to_folder, const char* to, unsigned flags) noexcept {
    return fails("n") ? -1 : static_cast<int>(syscall(SYS_renameat2, from_folder, from, to_folder, to, flags));
}

}  // extern "C"

namespace tex {
namespace {

const std::string kOld = "old";
const std::string kNew(100'000, 'n');

class AtomicFileFaults : public testing::TestWithParam<std::tuple<bool, bool, bool>>, protected Scratch {
protected:
    void SetUp() override { path_ = folder_ + "/a"; }
    [[nodiscard]] bool no_nameless() const { return std::get<0>(GetParam()); }
    [[nodiscard]] bool exists() const { return std::get<1>(GetParam()) && !std::get<2>(GetParam()); }
    [[nodiscard]] bool no_clobber() const { return std::get<2>(GetParam()); }
    void prepare() const {
        std::filesystem::remove(path_);
        if (exists()) std::ofstream(path_) << kOld;
    }
    // True if the old file is there, or if there is no file and there was none.
    [[nodiscard]] bool is_old() const { return exists() ? content(path_) == kOld : !std::filesystem::exists(path_); }
    [[nodiscard]] std::size_t strangers() const {
        std::size_t count = 0;
        for (const auto& entry : std::filesystem::directory_iterator(folder_)) count += entry.path() != path_;
        return count;
    }
    [[nodiscard]] Result<void> write_with(Faults plan, bool sync = true) const {
        WriteOptions options;
        options.sync = sync;
        options.no_clobber = no_clobber();
        plan.active = true;
        plan.no_nameless = no_nameless();
        faults = plan;
        Result<void> written = write_file(path_, bytes_of(kNew), options);
        faults.active = false;
        return written;
    }
    std::string path_;
};

TEST_P(AtomicFileFaults, AFailureAtAnyCallLeavesTheOldFileAndNothingElse) {
    for (const int error : {EIO, ENOSPC, EACCES}) {
        for (int n = 1;; ++n) {
            ASSERT_LT(n, 50);
            SCOPED_TRACE(testing::Message() << "call " << n << ", errno " << error);
            prepare();
            Faults plan;
            plan.fail_at = n;
            plan.error = error;
            const Result<void> written = write_with(plan);
            EXPECT_EQ(strangers(), 0u);
            if (written) {
                EXPECT_EQ(content(path_), kNew);
            } else {
                EXPECT_TRUE(is_old());
                EXPECT_EQ(written.error().code, ErrorCode::io);
                EXPECT_EQ(written.error().file, path_);
            }
            if (faults.calls < n) break;  // the write has fewer than n calls
        }
    }
}

TEST_P(AtomicFileFaults, DeathAtAnyCallLeavesTheOldFileOrTheNewOne) {
    for (int n = 1;; ++n) {
        ASSERT_LT(n, 50);
        SCOPED_TRACE(n);
        prepare();
        const pid_t child = fork();
        if (child == 0) {
            Faults plan;
            plan.fail_at = n;
            plan.kill = true;
            _exit(write_with(plan) ? 0 : 1);
        }
        int status = 0;
        waitpid(child, &status, 0);
        EXPECT_TRUE(is_old() || content(path_) == kNew);
        EXPECT_LE(strangers(), 1u);
        if (exists()) {  // the next write removes leftovers
            EXPECT_TRUE(write_with({}));
            EXPECT_EQ(strangers(), 0u);
        } else if (is_old()) {
            EXPECT_TRUE(write_with({}));
            EXPECT_TRUE(write_file(path_, bytes_of(kNew)));
            EXPECT_EQ(strangers(), 0u);
        }
        EXPECT_EQ(content(path_), kNew);
        if (!WIFSIGNALED(status)) break;
    }
}

// After a power cut, the bytes under the name must be on the disk. (A temporary name may come earlier; the last step
// gives the file its own name.)
TEST_P(AtomicFileFaults, BytesAreOnTheDiskBeforeTheyHaveTheName) {
    for (const bool sync : {true, false}) {
        prepare();
        ASSERT_TRUE(write_with({}, sync));
        const std::string& order = faults.order;
        ASSERT_TRUE(order.starts_with("w") && order.ends_with("n")) << order;
        EXPECT_EQ(order.find('s') == std::string::npos, !sync) << order;
        if (!sync) continue;
        EXPECT_LT(order.rfind('w'), order.find('s')) << order;
        EXPECT_LT(order.rfind('s'), order.find('n')) << order;
    }
}

TEST_P(AtomicFileFaults, InterruptedAndShortWritesAreFinished) {
    prepare();
    Faults plan;
    plan.dribble = true;
    const Result<void> written = write_with(plan);
    ASSERT_TRUE(written) << written.error().message();
    EXPECT_EQ(content(path_), kNew);
}

INSTANTIATE_TEST_SUITE_P(All, AtomicFileFaults, testing::Combine(testing::Bool(), testing::Bool(), testing::Bool()));

}  // namespace
}  // namespace tex
