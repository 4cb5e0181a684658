// SPDX-License-Identifier: Apache-2.0

#include "files/atomic_file.h"

#include <gtest/gtest.h>

#include <fcntl.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <random>
#include <thread>
#include <vector>

#include <tex/file.h>

#include "scratch.h"
#include "unit/file_text.h"

namespace tex {
namespace {

class AtomicFile : public testing::Test, protected Scratch {};

TEST_F(AtomicFile, WritesANewFileWithTheModeOfTheUmask) {
    const mode_t before = umask(027);
    const Result<void> written = write_file(path("a"), bytes_of("new"));
    umask(before);
    ASSERT_TRUE(written) << written.error().message();
    EXPECT_EQ(content(path("a")), "new");
    struct stat status {};
    ASSERT_EQ(stat(path("a").c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 07777, 0640u);
    EXPECT_EQ(files(), 1u);
}

TEST_F(AtomicFile, ReplacesAFileAndKeepsItsModeAndOwner) {
    std::ofstream(path("a")) << "old and longer";
    ASSERT_EQ(chmod(path("a").c_str(), 0604), 0);
    const bool root = geteuid() == 0;
    ASSERT_EQ(chown(path("a").c_str(), root ? 1234 : geteuid(), root ? 4321 : getegid()), 0);
    ASSERT_TRUE(write_file(path("a"), bytes_of("new")));
    EXPECT_EQ(content(path("a")), "new");
    struct stat status {};
    ASSERT_EQ(stat(path("a").c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 07777, 0604u);
    EXPECT_EQ(status.st_uid, root ? 1234 : geteuid());
    EXPECT_EQ(status.st_gid, root ? 4321 : getegid());
    EXPECT_EQ(files(), 1u);
}

TEST_F(AtomicFile, ReplacesALinkAndNotItsTargetIfAsked) {
    std::ofstream(path("target")) << "stays";
    std::filesystem::create_symlink("target", path("link"));
    std::filesystem::create_symlink("nowhere", path("dangling"));
    ASSERT_EQ(mkfifo(path("fifo").c_str(), 0600), 0);
    std::filesystem::create_directory(path("folder"));
    WriteOptions options;
    options.follow_links = false;
    for (const char* const name : {"link", "dangling", "fifo"}) {
        ASSERT_TRUE(write_file(path(name), bytes_of("new"), options)) << name;
        EXPECT_EQ(content(path(name)), "new");
        EXPECT_TRUE(std::filesystem::is_regular_file(std::filesystem::symlink_status(path(name)))) << name;
    }
    EXPECT_EQ(content(path("target")), "stays");
    EXPECT_FALSE(std::filesystem::exists(path("nowhere")));
    EXPECT_FALSE(write_file(path("folder"), bytes_of("new"), options));
    EXPECT_EQ(files(), 5u);
}

TEST_F(AtomicFile, AsksBeforeItReplacesAndSaysWhenItHas) {
    std::ofstream(path("a")) << "old";
    WriteOptions options;
    std::string seen;
    bool is_replaced = false;
    options.before_replacing = [&](const std::string& name, const std::string& complete) -> Result<void> {
        EXPECT_EQ(name, path("a"));
        EXPECT_EQ(content(path("a")), "old");
        seen = content(complete);
        return Error{ErrorCode::io, name, "no"};
    };
    options.replaced = [&](const std::string& name) { is_replaced = content(name) == "new"; };
    const Result<void> refused = write_file(path("a"), bytes_of("new"), options);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().reason, "no");
    EXPECT_EQ(content(path("a")), "old");
    EXPECT_EQ(seen, "new");
    EXPECT_FALSE(is_replaced);
    EXPECT_EQ(files(), 1u);
    options.before_replacing = {};
    ASSERT_TRUE(write_file(path("a"), bytes_of("new"), options));
    EXPECT_TRUE(is_replaced);
}

TEST_F(AtomicFile, NoClobberKeepsWhatIsThere) {
    WriteOptions options;
    options.no_clobber = true;
    ASSERT_TRUE(write_file(path("a"), bytes_of("first"), options));
    const Result<void> second = write_file(path("a"), bytes_of("second"), options);
    ASSERT_FALSE(second);
    EXPECT_EQ(second.error().code, ErrorCode::io);
    EXPECT_EQ(second.error().reason, "exists already");
    EXPECT_EQ(content(path("a")), "first");
    EXPECT_EQ(files(), 1u);
}

TEST_F(AtomicFile, FollowsLinksAlsoDanglingOnes) {
    ASSERT_EQ(mkdir(path("sub").c_str(), 0755), 0);
    ASSERT_EQ(symlink("sub/target", path("link").c_str()), 0);
    ASSERT_EQ(symlink("link", path("link2").c_str()), 0);
    ASSERT_TRUE(write_file(path("link2"), bytes_of("one")));
    EXPECT_EQ(content(path("sub/target")), "one");
    ASSERT_TRUE(write_file(path("link2"), bytes_of("two")));
    EXPECT_EQ(content(path("sub/target")), "two");
    EXPECT_TRUE(std::filesystem::is_symlink(path("link")));
    EXPECT_TRUE(std::filesystem::is_symlink(path("link2")));
    ASSERT_EQ(symlink("loop", path("loop").c_str()), 0);
    EXPECT_EQ(write_file(path("loop"), bytes_of("x")).error().code, ErrorCode::io);
}

TEST_F(AtomicFile, RefusesInPlainWords) {
    EXPECT_EQ(write_file(folder_, bytes_of("x")).error().reason, "is a directory");
    EXPECT_EQ(write_file(folder_ + "/", bytes_of("x")).error().reason, "is a directory");
    EXPECT_EQ(write_file(path("none/a"), bytes_of("x")).error().reason, "the directory does not exist");
    EXPECT_EQ(write_file("", bytes_of("x")).error().code, ErrorCode::io);
    EXPECT_EQ(write_file(path(std::string(300, 'n')), bytes_of("x")).error().reason, "file name too long");
    EXPECT_EQ(write_file("/proc/x", bytes_of("x")).error().code, ErrorCode::io);
    if (geteuid() != 0) {
        std::ofstream(path("protected")) << "old";
        ASSERT_EQ(chmod(path("protected").c_str(), 0444), 0);
        EXPECT_EQ(write_file(path("protected"), bytes_of("x")).error().reason, "permission denied");
        EXPECT_EQ(content(path("protected")), "old");
    }
}

TEST_F(AtomicFile, TakesNamesAsLongAsTheyMayBe) {
    const std::string name(255, 'n');
    ASSERT_TRUE(write_file(path(name), bytes_of("one")));
    ASSERT_TRUE(write_file(path(name), bytes_of("two")));
    EXPECT_EQ(content(path(name)), "two");
    EXPECT_EQ(files(), 1u);
}

TEST_F(AtomicFile, WritesThroughFifosAndDevices) {
    ASSERT_EQ(mkfifo(path("fifo").c_str(), 0600), 0);
    const std::string text(200'000, 'f');
    std::string got;
    std::thread reader([&] { got = content(path("fifo")); });
    const Result<void> written = write_file(path("fifo"), bytes_of(text));
    reader.join();
    ASSERT_TRUE(written);
    EXPECT_EQ(got, text);
    EXPECT_TRUE(write_file("/dev/null", bytes_of(text)));
    EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
    EXPECT_EQ(write_file("/dev/full", bytes_of(text)).error().reason, "cannot be written: no space left on the disk");
}

TEST_F(AtomicFile, APipeWithoutAReaderIsAnErrorAndNoSignal) {
    int ends[2];
    ASSERT_EQ(pipe(ends), 0);
    close(ends[0]);
    const Result<void> written = write_file("/dev/fd/" + std::to_string(ends[1]), bytes_of("x"));
    close(ends[1]);
    ASSERT_FALSE(written);
    EXPECT_EQ(written.error().reason, "cannot be written: broken pipe");
}

TEST_F(AtomicFile, SweepsADeadWritersFileButNotALivingOnes) {
    std::ofstream(path("a")) << "old";
    std::ofstream(path(".a.tex-tmp0")) << "living";
    std::ofstream(path(".a.tex-tmp1")) << "dead";
    const int living = open(path(".a.tex-tmp0").c_str(), O_RDONLY);
    ASSERT_EQ(flock(living, LOCK_EX), 0);
    ASSERT_TRUE(write_file(path("a"), bytes_of("new")));
    EXPECT_EQ(content(path("a")), "new");
    EXPECT_EQ(content(path(".a.tex-tmp0")), "living");
    EXPECT_FALSE(std::filesystem::exists(path(".a.tex-tmp1")));
    close(living);
    ASSERT_TRUE(write_file(path("a"), bytes_of("newer")));
    EXPECT_EQ(files(), 1u);
}

TEST_F(AtomicFile, AFullDiskLeavesTheOldFileAndNothingElse) {
    if (mount("tmpfs", folder_.c_str(), "tmpfs", 0, "size=64k") != 0) GTEST_SKIP() << "mounting a tmpfs needs root";
    ASSERT_TRUE(write_file(path("a"), bytes_of("old")));
    const Result<void> written = write_file(path("a"), bytes_of(std::string(200'000, 'x')));
    EXPECT_FALSE(written);
    if (!written) {
        EXPECT_EQ(written.error().code, ErrorCode::io);
        EXPECT_EQ(written.error().reason, "cannot be written: no space left on the disk");
    }
    EXPECT_EQ(content(path("a")), "old");
    EXPECT_EQ(files(), 1u);
    EXPECT_FALSE(write_file(path("b"), bytes_of(std::string(200'000, 'x'))));
    EXPECT_EQ(files(), 1u);
    umount(folder_.c_str());
}

TEST_F(AtomicFile, AFileSizeLimitIsAnError) {
    const pid_t child = fork();
    if (child == 0) {
        signal(SIGXFSZ, SIG_IGN);
        const rlimit limit{1000, 1000};
        setrlimit(RLIMIT_FSIZE, &limit);
        const Result<void> written = write_file(path("a"), bytes_of(std::string(200'000, 'x')));
        _exit(!written && written.error().code == ErrorCode::io ? 0 : 1);
    }
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_EQ(status, 0);
    EXPECT_EQ(files(), 0u);
}

TEST_F(AtomicFile, AKilledWriterLeavesTheOldFileOrTheNewOne) {
    const std::string one(300'000, '1');
    const std::string two(500'000, '2');
    ASSERT_TRUE(write_file(path("a"), bytes_of(one)));
    std::mt19937 random(1);
    WriteOptions options;
    options.sync = false;
    for (int round = 0; round < 200; ++round) {
        const pid_t child = fork();
        if (child == 0) {
            for (;;) {
                if (!write_file(path("a"), bytes_of(two), options) || !write_file(path("a"), bytes_of(one), options))
                    _exit(1);
            }
        }
        usleep(static_cast<useconds_t>(random() % 3000));
        kill(child, SIGKILL);
        int status = 0;
        waitpid(child, &status, 0);
        ASSERT_TRUE(WIFSIGNALED(status));
        const std::string now = content(path("a"));
        ASSERT_TRUE(now == one || now == two) << "round " << round << ", " << now.size() << " bytes";
        ASSERT_LE(files(), 2u);
    }
    ASSERT_TRUE(write_file(path("a"), bytes_of(one)));
    EXPECT_EQ(files(), 1u);
}

TEST_F(AtomicFile, ManyWritersOfOneFileLeaveOneWholeFile) {
    std::vector<std::thread> writers;
    std::atomic<int> failed{0};
    for (int k = 0; k < 8; ++k) {
        writers.emplace_back([&, k] {
            WriteOptions options;
            options.sync = false;
            const auto bytes = bytes_of(std::string(100'000, static_cast<char>('a' + k)));
            for (int round = 0; round < 50; ++round) failed += write_file(path("a"), bytes, options) ? 0 : 1;
        });
    }
    for (std::thread& writer : writers) writer.join();
    EXPECT_EQ(failed, 0);
    const std::string now = content(path("a"));
    EXPECT_EQ(now, std::string(100'000, now.at(0)));
    EXPECT_EQ(files(), 1u);
}

}  // namespace
}  // namespace tex
