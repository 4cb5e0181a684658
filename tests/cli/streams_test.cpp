// SPDX-License-Identifier: Apache-2.0
// Standard streams, full disks, signals.

#include <csignal>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "cli/program.h"

namespace tex::cli {

class Streams : public testing::Test {
protected:
    Streams() { scratch_.add_sample("bricks.png", "a.png"); }
    Scratch scratch_;
};

TEST_F(Streams, CommandsAreFilters) {
    ASSERT_EQ(run(scratch_, "bake-normals", {"a.png", "-o", "a.dds"}).code, 0);
    Setting input;
    input.input = scratch_.read("a.png");
    const Ran ran = run(scratch_, "bake-normals", {"-", "-o", "-"}, input);
    EXPECT_EQ(ran.code, 0) << ran.err;
    EXPECT_EQ(ran.out, scratch_.read("a.dds"));
    const Ran png = run(scratch_, "bake-normals", {"-", "-o", "-", "--container", "png"}, input);
    EXPECT_TRUE(png.out.starts_with("\x89PNG"));
    EXPECT_EQ(shell(scratch_, "bake-normals a.png -o >(cat > pipe.dds) --container dds").code, 0);
}

TEST_F(Streams, StandardOutputIsTheSameByAllItsNames) {
    ASSERT_EQ(run(scratch_, "bake-normals", {"a.png", "-o", "a.dds"}).code, 0);
    Setting full;
    full.stdout_path = "/dev/full";
    const Ran expected = run(scratch_, "bake-normals", {"a.png", "-o", "-"}, full);
    for (const std::string name : {"/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"}) {
        const Ran ran = run(scratch_, "bake-normals", {"a.png", "-o", name});
        EXPECT_EQ(ran.code, 0) << ran.err;
        EXPECT_EQ(ran.out, scratch_.read("a.dds")) << name;
        EXPECT_EQ(run(scratch_, "bake-normals", {"a.png", "-o", name}, full).err, expected.err) << name;
        for (const std::vector<std::string>& more :
             {std::vector<std::string>{"--json"}, {"--no-clobber"}, {"--depfile", "d"}}) {
            std::vector<std::string> arguments = {"a.png", "-o", name};
            arguments.insert(arguments.end(), more.begin(), more.end());
            EXPECT_EQ(run(scratch_, "bake-normals", arguments).code, 2) << name << " " << more.front();
        }
        EXPECT_EQ(
            shell(scratch_, "preview-normals a.dds -o " + name + " > p.png && head -c 4 p.png | grep -q PNG").code, 0)
            << name;
    }
}

// What holds for names (Files.AnOutputThatIsAnInputIsRefused): a file that the shell opened is still the same file.
TEST_F(Streams, TheFileBehindAStreamIsNoInputAndOutputAtOnce) {
    const std::string before = scratch_.read("a.png");
    for (const std::string script :
         {"bake-normals a.png -o - 1<>a.png", "bake-normals a.png -o - >> a.png", "bake-normals - -o a.png < a.png",
          "bake-normals - -o /dev/stdout < a.png 1<>a.png", "check-normals - --sarif a.png < a.png"}) {
        const Ran ran = shell(scratch_, script);
        EXPECT_EQ(ran.code, 2) << script;
        EXPECT_EQ(lines_of(ran.err).size(), 1u) << ran.err;
        EXPECT_EQ(scratch_.read("a.png"), before) << script;
    }
}

TEST_F(Streams, AFifoThatWaitsForItsReaderIsInterruptedInOneLine) {
    const Ran ran =
        shell(scratch_, "mkfifo p.dds; bake-normals a.png -o p.dds 2> err & sleep 0.5; kill -TERM $!; wait $!");
    EXPECT_EQ(ran.code, 128 + SIGTERM);
    EXPECT_EQ(scratch_.read("err"), "bake-normals: error: interrupted by SIGTERM; 0 of 1 files are done\n");
}

TEST_F(Streams, NothingIsSaidWhereNothingIsAsked) {
    const Ran ran = run(scratch_, "bake-normals", {"a.png", "--bumpiness", "1", "-o", "a.dds"});
    EXPECT_EQ(ran.out, "");
    EXPECT_EQ(ran.err, "");
}

TEST_F(Streams, ProgressIsForTerminalsUnlessAskedFor) {
    EXPECT_NE(run(scratch_, "bake-normals", {"a.png", "-o", "a.dds", "--progress", "always"}).err.find('%'),
              std::string::npos);
    EXPECT_EQ(run(scratch_, "bake-normals", {"a.png", "-o", "a.dds", "--progress", "always", "--quiet"}).err, "");
}

TEST_F(Streams, AFullDiskLeavesTheOldFile) {
    Setting full;
    full.stdout_path = "/dev/full";
    const Ran json = run(scratch_, "bake-normals", {"a.png", "--bumpiness", "1", "-o", "a.dds", "--json"}, full);
    EXPECT_EQ(json.code, 3);
    EXPECT_EQ(json.err, "bake-normals: error: standard output: no space left on the disk\n");
    const Ran data = run(scratch_, "bake-normals", {"a.png", "--bumpiness", "1", "-o", "-"}, full);
    EXPECT_EQ(data.code, 3);
    EXPECT_EQ(lines_of(data.err).size(), 1u) << data.err;
    // A limit on the size of files is the closest to a full disk that is possible without a mount.
    scratch_.write("a.dds", "old");
    const Ran limited = shell(scratch_, "ulimit -f 1; bake-normals a.png --bumpiness 1 -o a.dds --format float");
    EXPECT_EQ(limited.code, 3);
    EXPECT_EQ(lines_of(limited.err).size(), 1u) << limited.err;
    EXPECT_EQ(scratch_.read("a.dds"), "old");
    EXPECT_EQ(scratch_.list(), (std::vector<std::string>{"a.dds", "a.png"}));
}

TEST_F(Streams, AReaderThatWentAwayEndsTheRunQuietly) {
    const Ran json = shell(scratch_, "bake-normals a.png --bumpiness 1 -o a.dds --json | true; exit ${PIPESTATUS[0]}");
    EXPECT_TRUE(json.code == 3 || json.code == 0) << json.code;  // `true` may end after the line was written
    EXPECT_EQ(json.err, "");
    const Ran data = shell(scratch_, "{ sleep 0.2; bake-normals a.png --bumpiness 1 -o -; echo $? >&2; } | true");
    EXPECT_EQ(data.err, "3\n");
}

TEST_F(Streams, ClosedStreamsAreNotTakenForFiles) {
    const Ran ran = shell(scratch_, "bake-normals a.png -o a.dds --json >&-");
    EXPECT_EQ(ran.code, 3);
    EXPECT_TRUE(scratch_.read("a.dds").starts_with("DDS "));
    EXPECT_EQ(shell(scratch_, "bake-normals a.png -o b.dds <&- >&- 2>&-").code, 0);
    EXPECT_EQ(scratch_.read("a.dds"), scratch_.read("b.dds"));
    EXPECT_EQ(shell(scratch_, "bake-normals - -o c.dds <&-").code, 3);
}

TEST_F(Streams, SignalsEndTheRunAndLeaveNothing) {
    scratch_.add_sample("bricks.png", "bricks.png");
    for (const int signal : {SIGINT, SIGTERM}) {
        std::vector<std::string> arguments = {"--out-dir", "out", "--effort", "best", "--blur", "64"};
        for (int k = 0; k < 200; ++k) {
            std::string name = fmt::format("l{}.png", k);
            if (!scratch_.has(name)) std::filesystem::create_symlink("bricks.png", scratch_.path(name));
            arguments.push_back(std::move(name));
        }
        Setting interrupted;
        interrupted.signal = signal;
        interrupted.interrupt_after_ms = 400;
        const Ran ran = run(scratch_, "bake-normals", arguments, interrupted);
        EXPECT_EQ(ran.code, 128 + signal);
        EXPECT_NE(ran.err.find(signal == SIGINT ? "interrupted by SIGINT" : "interrupted by SIGTERM"),
                  std::string::npos)
            << ran.err;
        for (const auto& entry : std::filesystem::directory_iterator(scratch_.path("out"))) {
            EXPECT_EQ(entry.path().extension(), ".dds") << entry.path();
            EXPECT_GT(entry.file_size(), 300000u) << entry.path();  // complete: 512x512 with its levels
        }
    }
}

TEST_F(Streams, PicturesGoThroughPipesAsIntoFiles) {
    ASSERT_EQ(shell(scratch_, "bake-normals a.png -o a.dds").code, 0);
    for (const std::string kind : {"png", "exr"}) {
        const Ran ran =
            shell(scratch_, "unpack-normals a.dds -o x." + kind + " && unpack-normals a.dds -o - --container " + kind +
                                " | cat > y && cmp x." + kind + " y");
        EXPECT_EQ(ran.code, 0) << ran.err;
    }
}

// If a file's layout turns out to be an unusual one, the input is read twice and the output is begun twice. The reader
// of a FIFO must see one file.
TEST_F(Streams, AFifoSeesOneFileWhereTheInputIsReadTwice) {
    ASSERT_EQ(shell(scratch_,
                    "bake-normals a.png -o n.png --format ag8 --bumpiness 4 && pack-normals n.png -o x.dds --quiet && "
                    "mkfifo p.dds")
                  .code,
              0);
    for (int k = 0; k < 10; ++k) {
        const Ran ran = shell(
            scratch_,
            "timeout 10 cat p.dds > y & timeout 10 pack-normals n.png -o p.dds --quiet && wait $! && cmp x.dds y");
        ASSERT_EQ(ran.code, 0) << ran.err;
    }
}

// One large file in the middle of its stream: the first progress has been reported, and the rest takes seconds.
TEST_F(Streams, SignalsDuringALargeStreamLeaveNothing) {
    const std::string noise = "head -c $((3 * 2048 * 2048)) /dev/urandom";
    ASSERT_EQ(shell(scratch_, "{ printf 'P6 2048 2048 255\n'; " + noise + "; } > in.ppm").code, 0);
    for (const std::string command : {"bake-normals", "mip-normals"}) {
        for (const auto& [name, number] : {std::pair{"INT", SIGINT}, std::pair{"TERM", SIGTERM}}) {
            // Turns on job control, because a shell without it makes background processes ignore SIGINT.
            const Ran ran =
                shell(scratch_, "set -m; " + command +
                                    " in.ppm -o out.dds --effort best --metric angle --progress always 2>err & "
                                    "for k in {1..3000}; do grep -q % err 2>/dev/null && break; sleep 0.01; done; "
                                    "kill -" +
                                    name + " $!; wait $!; exit $?");
            EXPECT_EQ(ran.code, 128 + number) << command << scratch_.read("err");
            EXPECT_EQ(scratch_.list(), (std::vector<std::string>{"a.png", "err", "in.ppm"})) << command << name;
            std::filesystem::remove(scratch_.path("err"));
        }
    }
}

TEST_F(Streams, ABlockedReadCanBeInterrupted) {
    const Ran ran = shell(scratch_, "sleep 5 | timeout -s TERM 0.2 bake-normals - -o a.dds & wait $!; echo done");
    EXPECT_EQ(ran.out, "done\n");
    EXPECT_FALSE(scratch_.has("a.dds"));
}

}  // namespace tex::cli
