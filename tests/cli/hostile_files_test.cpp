// SPDX-License-Identifier: Apache-2.0
// Files that were made, or found, to break readers of pictures. Every command must read them, or say in one sentence
// what is wrong with them.

#include <algorithm>
#include <chrono>
#include <cstdlib>

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <gtest/gtest.h>

#include "cli/meshes.h"
#include "cli/program.h"
#include "reference/png_file.h"

extern char** environ;

namespace tex::cli {
namespace {

namespace fs = std::filesystem;

const fs::path kFolder = fs::path(TEX_SOURCE_DIR) / ".." / "shared" / "data" / "bad";

// The result of a command, and the resources that it and its child processes used.
struct Took {
    bool ended = false;  // on its own, within the time limit
    int status = 0;      // from wait4()
    double seconds = 0;  // of processor time
    long kib = 0;        // peak memory of one process
};

Took measure(const Scratch& scratch, std::vector<std::string> words, const std::string& errors) {
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions, 1, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_addopen(&actions, 2, errors.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    posix_spawn_file_actions_addchdir_np(&actions, scratch.path().c_str());
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    pid_t child = 0;
    const int failed = posix_spawn(&child, argv[0], &actions, nullptr, argv.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    Took took;
    if (failed != 0) return took;

    // So long that only a real hang reaches it, even on a busy machine. The cost of the work is measured in
    // processor time.
    constexpr int kHang = 100'000;  // ms
    const auto handle = static_cast<int>(syscall(SYS_pidfd_open, child, 0));
    pollfd ending{handle, POLLIN, 0};
    took.ended = poll(&ending, 1, kHang) == 1;
    if (!took.ended) kill(child, SIGKILL);
    rusage usage{};
    wait4(child, &took.status, 0, &usage);
    close(handle);
    const auto seconds = [](timeval time) {
        return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_usec) * 1e-6;
    };
    took.seconds = seconds(usage.ru_utime) + seconds(usage.ru_stime);
    took.kib = usage.ru_maxrss;
    return took;
}

// The command line for one file.
std::vector<std::string> arguments_for(const std::string& command, const std::string& file) {
    if (command == "check-normals") return {file};
    if (command == "compare-normals") return {file, file};
    if (command == "blend-normals") return {file, file, "-o", "out.dds"};
    if (command == "convert-normals") return {file, "-o", "out.png", "--mesh", "sheet.obj", "--to", "object"};
    if (command == "transfer-normals") return {file, file, "-o", "out.png"};
    if (command == "scale-normals") return {file, "-o", "out.dds", "--scale", "2"};
    if (command == "integrate-normals") return {file, "-o", "out.png", "--quiet"};  // it can warn, then fail
    if (command == "unpack-normals" || command == "preview-normals" || command == "integrate-normals")
        return {file, "-o", "out.png"};
    return {file, "-o", "out.dds"};
}

class HostileFiles : public testing::TestWithParam<std::string> {};

TEST_P(HostileFiles, AreReadOrRefusedInTimeAndMemory) {
    if (!fs::exists(kFolder)) GTEST_SKIP() << "no shared data";
#if defined(__SANITIZE_ADDRESS__)
    constexpr long kMost = 6 << 20;  // KiB: the allocator keeps freed memory
#else
    constexpr long kMost = 1 << 20;
#endif
    const Scratch scratch;
    scratch.write("sheet.obj", kSheetObj);
    int files = 0;
    for (const auto& entry : fs::directory_iterator(kFolder)) {
        const std::string file = fs::canonical(entry.path()).string();
        SCOPED_TRACE(file);
        ++files;
        std::vector<std::string> words = {std::string(TEX_BINARY_DIR "/") + GetParam()};
        for (const std::string& word : arguments_for(GetParam(), file)) words.push_back(word);
        words.insert(words.end(), {"--reader-timeout", "60", "--threads", "1"});
        const Took took = measure(scratch, words, scratch.path("errors"));
        const std::string errors = scratch.read("errors");
        ASSERT_TRUE(took.ended) << "hangs";
        ASSERT_TRUE(WIFEXITED(took.status)) << "signal " << WTERMSIG(took.status) << "\n" << errors;
        const int code = WEXITSTATUS(took.status);
        EXPECT_TRUE(code == 0 || code == 1 || code == 4) << code << "\n" << errors;
        EXPECT_LE(took.seconds, 10.0);
        EXPECT_LE(2 * took.kib, kMost);  // of the larger of two processes
        const bool wrote = scratch.has("out.dds") || scratch.has("out.png");
        const bool tells = GetParam() != "check-normals";  // it reports damage as a finding, on standard output
        if (code == 4 && tells) {
            EXPECT_EQ(std::count(errors.begin(), errors.end(), '\n'), 1) << errors;
        }
        EXPECT_FALSE(code == 4 && wrote);
        for (const char* name : {"out.dds", "out.png"}) fs::remove(scratch.path(name));
    }
    EXPECT_GE(files, 70);
}

// With the address sanitizer, which is slow, one command for each way of reading.
std::vector<std::string> tested_commands() {
#if defined(__SANITIZE_ADDRESS__)
    return {"bake-normals", "check-normals"};
#else
    std::vector<std::string> names = commands();
    std::erase(names, "build-normals");  // takes a manifest
    return names;
#endif
}

INSTANTIATE_TEST_SUITE_P(Commands, HostileFiles, testing::ValuesIn(tested_commands()), [](const auto& test) {
    std::string name = test.param;
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
});

// A chunk of text that claims 2 GB, in a file of 100 bytes.
TEST(HostilePng, TextThatIsNotThereTakesNoMemory) {
    const Scratch scratch;
    const std::string file = reference::write_png({reference::png_header({})}) + reference::big_endian(0x7ffffff0) +
                             "tEXtlibtex.normal" + std::string(50, '\0');
    scratch.write("a.png", file);
    const Ran ran = run(scratch, "bake-normals", {"a.png", "-o", "out.dds"});
    EXPECT_EQ(ran.code, 4);
    EXPECT_EQ(ran.err, "bake-normals: error: a.png: damaged PNG: the file ends too early\n");
    EXPECT_LT(ran.peak_bytes, std::int64_t{1} << 30);
}

}  // namespace
}  // namespace tex::cli
