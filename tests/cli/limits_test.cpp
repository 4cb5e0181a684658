// SPDX-License-Identifier: Apache-2.0
// Commands with little memory, no threads, small files or no rights, and every kind of target. Each must give an exit
// code and one sentence, and lose nothing.

#include <filesystem>
#include <set>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cli/meshes.h"
#include "cli/program.h"

namespace tex::cli {
namespace {

namespace fs = std::filesystem;

const std::string kOld = "the old file";

class Limits : public testing::Test {
protected:
    Limits() {
        scratch_.add_sample("waves.png", "a.png");
        scratch_.write("sheet.obj", kSheetObj);
        for (const std::string made : {"a.dds", "a.exr", "a.tif"}) {
            EXPECT_EQ(run(scratch_, "bake-normals",
                          {"a.png", "-o", made, "--format", made == "a.exr" ? "half" : "rgb8", "--no-sync"})
                          .code,
                      0);
        }
        before_ = scratch_.list();
    }

    // Runs a line of shell code, which then executes the command in its own process.
    Ran run_after(const std::string& line, const std::string& command) const {
        return shell(scratch_, fmt::format("ulimit -c 0; {}; exec {}", line, command));
    }

    // Expects the exit code and one sentence, and no new files.
    void expect_refused(const Ran& ran, const std::string& command) const {
        EXPECT_EQ(ran.code, 3) << ran.err;
        const auto lines = lines_of(ran.err);
        EXPECT_TRUE(lines.size() == 1 && lines[0].starts_with(command.substr(0, command.find(' ')) + ": error: "))
            << ran.err;
        EXPECT_EQ(scratch_.list(), before_);
    }

    Scratch scratch_;
    std::vector<std::string> before_;
};

// If this runs as root, drops the rights over other users' files. The program may still enter the folders of the
// programs.
std::string as_nobody(const std::string& capability = "dac_read_search") {
    if (geteuid() != 0) return {};
    return fmt::format(
        "setpriv --reuid=65534 --regid=65534 --clear-groups --inh-caps=-all,+{0} --ambient-caps=-all,+{0} ",
        capability);
}

// -- memory ----------------------------------------------------------------------------------------------------

struct Memory {
    const char* name;
    const char* command;
    int from, step;  // KiB
};
void PrintTo(const Memory& memory, std::ostream* out) { *out << memory.name; }

const Memory kMemories[] = {
    {"Stream", "bake-normals a.png --bumpiness 20 -o out.dds", 16'000, 500},
    {"Whole", "bake-normals a.png --bumpiness 20 -o out.exr --format half --fill-invalid", 16'000, 800},
    {"Levels", "mip-normals a.exr -o out.exr", 16'000, 800},
    {"Picture", "preview-normals a.dds -o out.png --size 64", 16'000, 800},
    {"Blended", "blend-normals a.dds --detail a.exr -o out.dds", 16'000, 900},
    {"Converted", "convert-normals a.exr -o out.dds --mesh sheet.obj --to object", 16'000, 900},
    {"OtherReader", "bake-normals a.tif -o out.dds", 16'000, 1'000},
    {"OtherWriter", "unpack-normals a.dds -o out.tif", 16'000, 1'000},
};

class LittleMemory : public Limits, public testing::WithParamInterface<Memory> {};

// From the memory that the loader needs to the memory that the work needs. A failure of the loader itself has status
// 127.
TEST_P(LittleMemory, IsOneSentence) {
    const Memory& memory = GetParam();
    const std::string output = std::string(memory.command).substr(std::string_view(memory.command).find("out."), 7);
    ASSERT_EQ(shell(scratch_, fmt::format("{} --no-sync --quiet", memory.command)).code, 0);
    const std::string whole = scratch_.read(output);
    int refused = 0, done = 0;
    for (int limit = memory.from; done < 2; limit += memory.step) {
        SCOPED_TRACE(testing::Message() << limit << " KiB");
        ASSERT_LT(limit, 4'000'000);
        scratch_.write(output, kOld);
        const Ran ran =
            run_after(fmt::format("ulimit -v {}", limit), fmt::format("{} --no-sync --quiet", memory.command));
        if (ran.code == 127 && refused + done == 0) continue;
        if (ran.code == 0) {
            EXPECT_EQ(scratch_.read(output), whole);
            ++done;
            continue;
        }
        EXPECT_EQ(scratch_.read(output), kOld);
        fs::remove(scratch_.path(output));
        expect_refused(ran, memory.command);
        ++refused;
    }
    EXPECT_GE(refused, 3);
}

INSTANTIATE_TEST_SUITE_P(Commands, LittleMemory, testing::ValuesIn(kMemories),
                         [](const auto& test) { return std::string(test.param.name); });

// TBB allocates memory where it starts a thread, and nobody can catch that exception.
TEST_F(Limits, AThreadWithoutMemoryIsReplacedOrIsOneSentence) {
    const std::string preload = "export LD_PRELOAD=" TEX_BINARY_DIR "/no_thread_memory.so";
    const std::string command = "preview-normals a.dds -o out.png --threads 4";
    ASSERT_EQ(shell(scratch_, command).code, 0);
    const std::string whole = scratch_.read("out.png");
    for (const char* size : {"", " --size 4096"}) {  // less than the second that the other threads have, and more
        fs::remove(scratch_.path("out.png"));
        const Ran ran = run_after(preload, command + size);
        if (ran.code != 0) {
            expect_refused(ran, command);
        } else if (*size == '\0') {
            EXPECT_EQ(scratch_.read("out.png"), whole);
        }
    }
}

// -- what files may claim, and what their decoders may use ----------------------------------------------------------

TEST_F(Limits, MoreTexelsThanAllowedAreRefusedInEveryFormat) {
    for (const std::string kind : {"ktx2", "tga", "jpg", "bmp"}) {
        ASSERT_EQ(shell(scratch_, fmt::format("bake-normals a.png --no-sync --format {} -o a.{}",
                                              kind == "ktx2" ? "rgba8" : "rgb8", kind))
                      .code,
                  0)
            << kind;
    }
    before_ = scratch_.list();
    for (const std::string kind : {"png", "exr", "dds", "ktx2", "tif", "tga", "jpg", "bmp"}) {
        for (const std::string command : {"bake-normals a.K -o out.dds", "pack-normals a.K -o out.dds",
                                          "preview-normals a.K -o out.png", "compare-normals a.K a.K"}) {
            const bool is_read_whole = command.starts_with("preview") || command.starts_with("compare");
            if (is_read_whole && kind != "png" && kind != "dds") continue;
            std::string line = command;
            for (std::size_t at = 0; (at = line.find('K', at)) != std::string::npos; at += kind.size())
                line.replace(at, 1, kind);
            SCOPED_TRACE(line);
            const Ran refused = shell(scratch_, line + " --quiet --max-texels 16383");
            EXPECT_EQ(refused.code, 4);
            EXPECT_NE(refused.err.find("a." + kind + ": 128x128 texels are more than the limit of 16383\n"),
                      std::string::npos)
                << refused.err;
            EXPECT_EQ(lines_of(refused.err).size(), 1u) << refused.err;
            EXPECT_EQ(scratch_.list(), before_);
        }
        if (kind != "png") continue;
        EXPECT_EQ(shell(scratch_, "bake-normals a.png --bumpiness 20 -o out.dds --no-sync --max-texels 16K").code,
                  0);  // exactly the limit
        fs::remove(scratch_.path("out.dds"));
    }
}

#if !defined(__SANITIZE_ADDRESS__)  // it maps terabytes, so the reader's memory is not limited
TEST_F(Limits, AReaderHasTheMemoryThatItIsGiven) {
    ASSERT_EQ(shell(scratch_, "preview-normals a.dds -o b.tif --show plain --size 3000 --no-sync").code, 0);
    before_ = scratch_.list();
    const Ran ran = shell(scratch_, "bake-normals b.tif -o out.dds --reader-memory 24M");
    EXPECT_EQ(ran.code, 4);
    EXPECT_EQ(ran.err, "bake-normals: error: b.tif: needs more memory than the 24 MiB that a decoder may have\n");
    EXPECT_EQ(scratch_.list(), before_);
    EXPECT_EQ(shell(scratch_, "bake-normals b.tif -o out.dds --no-sync --quiet --reader-memory 2G").code, 0);
}
#endif

// -- threads, processes, sizes of files -----------------------------------------------------------------------------

TEST_F(Limits, WithoutThreadsTheBytesAreTheSame) {
    ASSERT_EQ(run(scratch_, "bake-normals", {"a.png", "-o", "four.dds", "--threads", "4", "--bumpiness", "20"}).code,
              0);
    const std::string nobody = as_nobody("dac_override");
    const Ran ran = shell(
        scratch_, nobody + "bash -c 'ulimit -u 1; exec bake-normals a.png --bumpiness 20 -o one.dds --threads 4'");
    EXPECT_EQ(ran.code, 0) << ran.err;
    EXPECT_EQ(ran.err, "");
    EXPECT_EQ(scratch_.read("one.dds"), scratch_.read("four.dds"));
    before_ = scratch_.list();
    expect_refused(shell(scratch_, nobody + "bash -c 'ulimit -u 1; exec bake-normals a.tif -o out.dds'"),
                   "bake-normals");
}

TEST_F(Limits, SmallFilesAreOneSentence) {
    for (const std::string command : {"bake-normals a.png --bumpiness 20 -o out.dds", "bake-normals a.tif -o out.dds",
                                      "unpack-normals a.dds -o out.tif", "mip-normals a.exr -o out.exr",
                                      "preview-normals a.dds -o out.png", "check-normals a.dds --report out.html"}) {
        SCOPED_TRACE(command);
        expect_refused(run_after("ulimit -f 2", command), command);
    }
}

// From the number that the loader needs to the number that the work needs. Each run must name the missing resource.
TEST_F(Limits, FewDescriptorsAreOneSentence) {
    for (const std::string command : {"bake-normals a.tif -o out.dds", "unpack-normals a.dds -o out.tif"}) {
        int refused = 0;
        for (int limit = 5; limit <= 24; ++limit) {
            SCOPED_TRACE(testing::Message() << command << " with " << limit << " descriptors");
            const Ran ran = run_after(fmt::format("ulimit -n {}", limit), command + " --no-sync --quiet");
            if (ran.code == 0) {
                fs::remove(scratch_.path(command.substr(command.find("out."))));
                continue;
            }
            expect_refused(ran, command);
            EXPECT_NE(ran.err.find("too many open files"), std::string::npos) << ran.err;
            ++refused;
        }
        EXPECT_GE(refused, 1);
        EXPECT_LE(refused, 10);
    }
}

// -- rights ----------------------------------------------------------------------------------------------------

TEST_F(Limits, FilesOfOthersAndFoldersThatAreClosedStayAsTheyAre) {
    fs::create_directory(scratch_.path("open"));
    fs::create_directory(scratch_.path("closed"));
    const std::vector<std::pair<std::string, std::string>> cases = {
        {"bake-normals a.png --bumpiness 20 -o ", "out.dds"},
        {"bake-normals a.png --bumpiness 20 -o ", "out.png"},
        {"mip-normals a.exr -o ", "out.exr"},
        {"unpack-normals a.dds -o ", "out.tif"},
        {"bake-normals a.png --bumpiness 20 -o open/d.dds --depfile ", "out.d"},
        {"check-normals a.dds --report ", "out.html"}};
    for (const auto& [command, output] : cases) {
        for (const char* folder : {"open", "closed"}) {
            scratch_.write(folder + ("/" + output), kOld);
            chmod(scratch_.path(folder + ("/" + output)).c_str(), 0444);
        }
    }
    chmod(scratch_.path("open").c_str(), 0777);
    chmod(scratch_.path("closed").c_str(), 0555);
    for (const auto& [command, output] : cases) {
        for (const std::string& target : {"open/" + output, "closed/" + output, "closed/new." + output}) {
            SCOPED_TRACE(command + target);
            const Ran ran = shell(scratch_, fmt::format("{}bash -c 'exec {}{}'", as_nobody(), command, target));
            EXPECT_EQ(ran.code, 3) << ran.err;
            const auto lines = lines_of(ran.err);
            EXPECT_TRUE(lines.size() == 1 && lines[0].find(target) != std::string::npos &&
                        lines[0].find("permission denied") != std::string::npos)
                << ran.err;
            EXPECT_EQ(scratch_.read(target), scratch_.has(target) ? kOld : "");
        }
    }
    EXPECT_EQ(std::distance(fs::directory_iterator(scratch_.path("closed")), {}),
              static_cast<std::ptrdiff_t>(cases.size()));
    chmod(scratch_.path("closed").c_str(), 0755);
}

// -- targets ---------------------------------------------------------------------------------------------------

TEST_F(Limits, TargetsOfEveryKindGetTheSameBytes) {
    const std::pair<std::string, std::string> lines[] = {{"bake-normals a.png --bumpiness 20", "dds"},
                                                         {"bake-normals a.png --bumpiness 20", "ktx2"},
                                                         {"preview-normals a.dds", "png"},
                                                         {"mip-normals a.exr", "exr"},
                                                         {"unpack-normals a.dds", "tif"}};
    for (const auto& [command, kind] : lines) {
        SCOPED_TRACE(command);
        ASSERT_EQ(shell(scratch_, fmt::format("{} -o file.{}", command, kind)).code, 0);
        const std::string whole = scratch_.read("file." + kind);
        const std::string container = kind == "tif" ? "tiff" : kind;
        // O stands for the target. The bytes of the target are then in got.KIND.
        for (const std::string script :
             {"mkfifo O; cat O > got & C -o O; code=$?; wait; rm O; exit $code", "C -o /dev/stdout --container K > got",
              "C -o - --container K | cat > got", "C -o /dev/fd/3 --container K 3> got",
              "touch got; ln -s got O; C -o O && test -L O && rm O", "ln -s got O; C -o O && test -L O && rm O"}) {
            std::string line = "set -o pipefail; " + script;
            for (const auto& [mark, text] :
                 {std::pair<std::string, std::string>{"O", "o." + kind}, {"C", command}, {"K", container}}) {
                for (std::size_t at = 0; (at = line.find(mark, at)) != std::string::npos; at += text.size())
                    line.replace(at, 1, text);
            }
            const Ran ran = shell(scratch_, line);
            EXPECT_EQ(ran.code, 0) << line << "\n" << ran.err;
            EXPECT_TRUE(scratch_.read("got") == whole) << line;
            fs::remove(scratch_.path("got"));
        }
        fs::remove(scratch_.path("file." + kind));
        EXPECT_EQ(scratch_.list(), before_);
    }
}

// -- company ---------------------------------------------------------------------------------------------------

TEST_F(Limits, ProcessesThatWriteOneOutputLeaveOneWholeFile) {
    std::set<std::string> wholes;
    std::string all;
    for (const std::string bumpiness : {"20", "21", "22", "23"}) {
        ASSERT_EQ(run(scratch_, "bake-normals", {"a.png", "-o", "out.dds", "--bumpiness", bumpiness}).code, 0);
        wholes.insert(scratch_.read("out.dds"));
        all += fmt::format("bake-normals a.png -o out.dds --bumpiness {} & ", bumpiness);
    }
    ASSERT_EQ(wholes.size(), 4u);
    const auto files = scratch_.list();
    const std::string without_nameless = "export LD_PRELOAD=" TEX_BINARY_DIR "/faults.so TEX_FAULT_NO_TMPFILE=1; ";
    for (int round = 0; round < 6; ++round) {
        SCOPED_TRACE(round);
        if (round % 3 == 0) fs::remove(scratch_.path("out.dds"));
        const Ran ran = shell(scratch_, (round % 2 == 0 ? "" : without_nameless) + all +
                                            "for job in $(jobs -p); do wait $job || exit; done");
        EXPECT_EQ(ran.code, 0) << ran.err;
        EXPECT_EQ(ran.err, "");
        EXPECT_TRUE(wholes.contains(scratch_.read("out.dds")));
        EXPECT_EQ(scratch_.list(), files);
    }
}

}  // namespace
}  // namespace tex::cli
