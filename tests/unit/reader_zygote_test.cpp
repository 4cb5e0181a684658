// SPDX-License-Identifier: Apache-2.0
// The zygote, and what goes wrong around it: it is killed or stopped, it cannot fork, its parent dies, and it has the
// descriptors of several files. sandbox_test.cpp tries the rights that it gives up.

#include "formats/reader/reader_zygote.h"

#include <fcntl.h>
#include <sched.h>
#include <seccomp.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <charconv>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "formats/reader/reader_process.h"
#include "unit/child_text.h"

namespace tex {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kPicture("P5 2 1 255\n\xff\x00", 13);

// Whether the condition comes true within ten seconds.
bool soon(const std::function<bool()>& condition) {
    for (int tries = 0; tries < 1000; ++tries) {
        if (condition()) return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
}

// The line of /proc/PROCESS/status that begins with `name`, without it; empty if there is no such process.
std::string status_of(pid_t process, const std::string& name) {
    std::ifstream file("/proc/" + std::to_string(process) + "/status");
    for (std::string line; std::getline(file, line);) {
        if (line.starts_with(name + ":\t")) return line.substr(name.size() + 2);
    }
    return {};
}

bool is_running(pid_t process) {
    const std::string state = status_of(process, "State");
    return !state.empty() && state[0] != 'Z' && state[0] != 'X';
}

std::set<pid_t> children_of(pid_t parent) {
    std::set<pid_t> found;
    for (const fs::directory_entry& entry : fs::directory_iterator("/proc")) {
        const std::string name = entry.path().filename();
        pid_t process = 0;
        const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), process);
        if (error == std::errc() && *end == '\0' && status_of(process, "PPid") == std::to_string(parent))
            found.insert(process);
    }
    return found;
}

std::set<int> descriptors_of(pid_t process) {
    std::set<int> found;
    for (const fs::directory_entry& entry : fs::directory_iterator("/proc/" + std::to_string(process) + "/fd"))
        found.insert(std::stoi(entry.path().filename()));
    return found;
}

ReadOptions within(int seconds) {
    ReadOptions options;
    options.reader_timeout = seconds;
    return options;
}

// Reads a picture.
std::string read_picture(const ReadOptions& options = within(20)) {
    std::string pattern = testing::TempDir() + "zygote_XXXXXX";
    const Descriptor file(mkstemp(pattern.data()));
    if (!file || write(file.get(), kPicture.data(), kPicture.size()) < 0) return "no file";
    const Result<Image> image = read_image(pattern, options);
    fs::remove(pattern);
    if (!image) return image.error().reason;
    return image->planes[0].at(0, 0) == 1.0f && image->planes[0].at(1, 0) == 0.0f ? "" : "other texels";
}

// Reads a picture, and says whether there is a zygote afterwards.
std::string read_and_look() {
    const std::string reason = read_picture();
    return reason + (is_running(zygote_id()) ? "zygote\n" : "none\n");
}

// A zygote that has forked.
pid_t running_zygote() {
    for (int k = 0; k < 2 || (k < 5 && zygote_id() < 0); ++k) EXPECT_EQ(read_picture(), "");
    return zygote_id();
}

// A reader that has been forked, and that waits for room for its result until somebody waits for it.
class Pending {
public:
    explicit Pending(const ReadOptions& options = within(20)) {
        const std::set<pid_t> before = children_of(running_zygote());
        write_exactly(input_->get(), 0, std::as_bytes(std::span(kPicture)));
        process_.emplace(ReaderProcess::start({"file", "decode", "pnm", input_->get(), result_->get()}, options));
        EXPECT_TRUE(*process_);
        for (const pid_t child : children_of(zygote_id())) {
            if (!before.contains(child)) id_ = child;
        }
        ReaderHeader header;
        EXPECT_TRUE(soon([&] { return pread(result_->get(), &header, sizeof header, 0) > 0 && header.width > 0; }));
    }
    [[nodiscard]] pid_t id() const { return id_; }
    std::string finish() {
        const Result<ReaderHeader> header = (*process_)->finish();
        return header ? "" : header.error().reason;
    }

private:
    Result<Descriptor> input_ = memory_file({}), result_ = memory_file({});
    std::optional<Result<ReaderProcess>> process_;
    pid_t id_ = -1;
};

std::vector<std::string> lines_of(const std::string& text) {
    std::istringstream stream(text);
    std::vector<std::string> lines;
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

// What body() returns in its own process, whose zygote is another one.
std::string apart(const std::function<std::string()>& body) {
    return child_text([&](int out) {
        const std::string text = body();
        return write(out, text.data(), text.size()) == static_cast<ssize_t>(text.size()) ? 0 : 1;
    });
}

}  // namespace

TEST(ReaderZygote, BeginsWithTheSecondFile) {
    const std::string reads = apart([] {
        std::string text;
        for (int k = 0; k < 3; ++k) text += read_and_look();
        return text;
    });
    // A process that was forked from one that has read files is not at its first.
    EXPECT_EQ(reads, zygote_id() > 0 ? "zygote\nzygote\nzygote\n" : "none\nzygote\nzygote\n");
    const pid_t zygote = running_zygote();
    EXPECT_GT(zygote, 0);
    EXPECT_EQ(read_picture(), "");
    EXPECT_EQ(zygote_id(), zygote);
}

TEST(ReaderZygote, IsNotUsedForAnotherProgram) {
    running_zygote();
    ReadOptions options = within(20);
    options.reader = "/bin/false";
    EXPECT_EQ(read_picture(options), "the decoder ended without a result (exit status 1)");
}

TEST(ReaderZygote, HasOneThreadAndTheDescriptorsThatItNeeds) {
    const pid_t zygote = running_zygote();
    EXPECT_EQ(status_of(zygote, "Threads"), "1");
    EXPECT_EQ(status_of(zygote, "NoNewPrivs"), "1");
    EXPECT_EQ(status_of(zygote, "Seccomp"), "2");
    EXPECT_TRUE(soon([&] { return descriptors_of(zygote) == std::set{0, 1, 2, 3, 4, 5}; }));
}

// Neither the sockets of the zygote nor anything of another file.
TEST(ReaderZygote, GivesEachReaderItsDescriptorsAndNoOthers) {
    Pending one;
    Pending two;
    ASSERT_GT(one.id(), 0);
    ASSERT_GT(two.id(), 0);
    for (const pid_t reader : {one.id(), two.id()}) {
        const std::string fd = "/proc/" + std::to_string(reader) + "/fd/";
        EXPECT_EQ(descriptors_of(reader), (std::set{0, 1, 2, 3, 4, 5, 6}));
        EXPECT_EQ(fs::read_symlink(fd + "6"), fs::read_symlink(fd + "4")) << "the decoder has opened its input";
        EXPECT_NE(fs::read_symlink(fd + "3").string().find("libtex"), std::string::npos);
        EXPECT_NE(fs::read_symlink(fd + "4").string().find("libtex"), std::string::npos);
        EXPECT_TRUE(fs::read_symlink(fd + "5").string().starts_with("pipe:"));
    }
    EXPECT_EQ(one.finish(), "");
    EXPECT_EQ(two.finish(), "");
}

// As a reader that was started from its program.
TEST(ReaderZygote, GivesEachReaderItsLimitsAndRestrictions) {
    ReadOptions options = within(30);
    options.reader_memory = std::int64_t{3} << 30;
    Pending pending(options);
    const auto limit = [&](__rlimit_resource what) {
        rlimit now{};
        EXPECT_EQ(prlimit(pending.id(), what, nullptr, &now), 0);
        return now.rlim_max;
    };
#if !defined(__SANITIZE_ADDRESS__)
    EXPECT_EQ(limit(RLIMIT_AS), rlim_t{3} << 30);
#endif
    EXPECT_EQ(limit(RLIMIT_FSIZE), rlim_t{3} << 30);
    EXPECT_EQ(limit(RLIMIT_CPU), 31u);
    EXPECT_EQ(limit(RLIMIT_CORE), 0u);
    EXPECT_EQ(limit(RLIMIT_NOFILE), 64u);
    EXPECT_EQ(status_of(pending.id(), "Threads"), "1");
    EXPECT_EQ(status_of(pending.id(), "NoNewPrivs"), "1");
    EXPECT_EQ(status_of(pending.id(), "Seccomp"), "2");
    EXPECT_EQ(status_of(pending.id(), "Seccomp_filters"), "2");
    EXPECT_EQ(getpgid(pending.id()), pending.id());
    EXPECT_EQ(pending.finish(), "");
}

#if !defined(__SANITIZE_ADDRESS__)
TEST(ReaderZygote, GivesAReaderNoMoreMemoryThanAllowed) {
    running_zygote();
    ReadOptions options = within(20);
    options.reader_memory = std::int64_t{100} << 20;
    EXPECT_EQ(read_picture(options), "needs more memory than the 100 MiB that a decoder may have");
    EXPECT_EQ(read_picture(), "");
}
#endif

TEST(ReaderZygote, ACrashCostsOneFile) {
    Pending one;
    Pending two;
    const pid_t zygote = zygote_id();
    ASSERT_GT(one.id(), 0);
    kill(one.id(), SIGABRT);  // the address sanitizer handles SIGSEGV itself
    EXPECT_EQ(one.finish(), "the decoder crashed on this file (signal 6)");
    EXPECT_EQ(two.finish(), "");
    EXPECT_EQ(read_picture(), "");
    EXPECT_EQ(zygote_id(), zygote);
}

TEST(ReaderZygote, AReaderThatHangsIsStopped) {
    Pending pending(within(1));
    ASSERT_GT(pending.id(), 0);
    kill(pending.id(), SIGSTOP);
    EXPECT_EQ(pending.finish(), "the decoder did not end within 1 s");
    EXPECT_FALSE(is_running(pending.id()));
}

TEST(ReaderZygote, AReaderThatNobodyWaitsForEnds) {
    pid_t reader = -1;
    {
        const Pending pending;
        reader = pending.id();
        EXPECT_TRUE(is_running(reader));
    }
    EXPECT_TRUE(soon([&] { return status_of(reader, "State").empty(); }));
}

TEST(ReaderZygote, IsStartedOnceMoreIfItWasKilled) {
    const pid_t zygote = running_zygote();
    kill(zygote, SIGKILL);
    EXPECT_EQ(read_picture(), "");
    EXPECT_NE(zygote_id(), zygote);
    EXPECT_GT(zygote_id(), 0);
    EXPECT_TRUE(status_of(zygote, "State").empty()) << "it has been collected";
}

TEST(ReaderZygote, AFileThatWasReadWhenItWasKilledIsOneSentence) {
    Pending pending;
    const pid_t zygote = zygote_id();
    ASSERT_GT(pending.id(), 0);
    kill(pending.id(), SIGSTOP);
    kill(zygote, SIGKILL);
    EXPECT_EQ(pending.finish(), "the decoder ended with the process that started it, which was killed: out of memory?");
    EXPECT_TRUE(soon([&] { return !is_running(pending.id()); }));
    EXPECT_EQ(read_picture(), "");
    EXPECT_NE(zygote_id(), zygote);
}

TEST(ReaderZygote, OneThatDoesNotAnswerIsReplaced) {
    const pid_t zygote = running_zygote();
    kill(zygote, SIGSTOP);
    EXPECT_EQ(read_picture(within(1)), "the decoder did not end within 1 s");
    EXPECT_EQ(read_picture(), "");
    EXPECT_NE(zygote_id(), zygote);
    EXPECT_TRUE(status_of(zygote, "State").empty()) << "it has been ended and collected";
}

// PR_SET_PDEATHSIG reports the end of a thread, too.
TEST(ReaderZygote, SurvivesTheThreadThatStartedIt) {
    const pid_t killed = running_zygote();
    kill(killed, SIGKILL);
    std::thread([] { EXPECT_EQ(read_picture(), ""); }).join();
    const pid_t zygote = zygote_id();
    EXPECT_NE(zygote, killed);
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    EXPECT_TRUE(is_running(zygote));
    EXPECT_EQ(read_picture(), "");
    EXPECT_EQ(zygote_id(), zygote);
}

TEST(ReaderZygote, EndsWithItsReadersWhenItsParentIsKilled) {
    int ends[2];
    ASSERT_EQ(pipe(ends), 0);
    const pid_t parent = fork();
    if (parent == 0) {
        const Pending pending;
        const pid_t ids[] = {zygote_id(), pending.id()};
        if (write(ends[1], ids, sizeof ids) < 0) _exit(1);
        for (;;) pause();
    }
    pid_t ids[2] = {-1, -1};
    EXPECT_EQ(::read(ends[0], ids, sizeof ids), static_cast<ssize_t>(sizeof ids));
    for (const pid_t id : ids) EXPECT_TRUE(id > 0 && is_running(id)) << id;
    kill(parent, SIGKILL);
    waitpid(parent, nullptr, 0);
    for (const pid_t id : ids) EXPECT_TRUE(soon([&] { return !is_running(id); })) << id;
    for (const int end : ends) close(end);
}

TEST(ReaderZygote, IsNotTheOneOfAForkedProcess) {
    const pid_t zygote = running_zygote();
    const std::string ids = apart([&] {
        const std::string before = zygote_id() == zygote ? "the same" : "";
        return before + read_picture() + (zygote_id() == zygote ? "the same" : "");
    });
    EXPECT_EQ(ids, "");
    EXPECT_TRUE(is_running(zygote));
    EXPECT_EQ(read_picture(), "");
    EXPECT_EQ(zygote_id(), zygote);
}

// A filter answers as the kernel does if there may be no more processes: to fork() first, then to posix_spawn(), too.
TEST(ReaderZygote, AFullProcessTableIsOneSentence) {
    const auto refuse_clone = [](scmp_datum_t mask, scmp_datum_t flags) {
        scmp_filter_ctx filter = seccomp_init(SCMP_ACT_ALLOW);
        const bool sound = seccomp_rule_add(filter, SCMP_ACT_ERRNO(ENOSYS), SCMP_SYS(clone3), 0) == 0 &&
                           seccomp_rule_add(filter, SCMP_ACT_ERRNO(EAGAIN), SCMP_SYS(clone), 1,
                                            scmp_arg_cmp{0, SCMP_CMP_MASKED_EQ, mask, flags}) == 0 &&
                           seccomp_load(filter) == 0;
        seccomp_release(filter);
        return sound;
    };
    const std::string reasons = apart([&] {
        if (!refuse_clone(CLONE_VM, 0)) return std::string("no filter");
        std::string text;
        for (int k = 0; k < 3; ++k) text += read_and_look();
        if (!refuse_clone(CLONE_THREAD, 0)) return std::string("no filter");
        for (int k = 0; k < 2; ++k) text += read_picture() + "\n";
        return text;
    });
    const std::vector<std::string> lines = lines_of(reasons);
    ASSERT_EQ(lines.size(), 5u) << reasons;
    EXPECT_EQ(lines[1], "zygote") << "which cannot fork: the program is started";
    EXPECT_EQ(lines[2], "zygote");
    for (const std::size_t k : {3u, 4u}) {
        EXPECT_TRUE(lines[k].ends_with("tex-reader cannot be started: resource temporarily unavailable")) << lines[k];
    }
}

TEST(ReaderZygote, WithoutDescriptorsAReaderIsStartedFromItsProgram) {
    const pid_t zygote = running_zygote();
    const rlimit few{7, 7};
    ASSERT_EQ(prlimit(zygote, RLIMIT_NOFILE, &few, nullptr), 0);
    for (int k = 0; k < 3; ++k) EXPECT_EQ(read_picture(), "");
    EXPECT_EQ(zygote_id(), zygote);
    kill(zygote, SIGKILL);  // not for the next test
}

}  // namespace tex
