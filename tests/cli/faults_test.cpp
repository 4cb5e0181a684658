// SPDX-License-Identifier: Apache-2.0
// Whatever fails while a command runs, and whenever it fails: each output is the complete old file or the complete new
// one, and no other file is left. The commands run under tests/preload/faults.cpp. To test another way of writing, add
// its command line to kCases.

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <map>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "cli/meshes.h"
#include "cli/program.h"
#include "unit/gltf_files.h"

namespace tex::cli {
namespace {

struct Case {
    const char* name;
    const char* command;
    std::vector<std::string> arguments;
    const char* input;          // an input that is made first, besides a.png and b.png
    bool needs_reader = false;  // the reader takes long to start
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

const Case kCases[] = {
    {"Texture", "bake-normals", {"a.png", "-o", "out.dds", "--threads", "2"}, ""},
    {"Baked", "bake-normals", {"a.png", "-o", "out.png", "--threads", "2"}, ""},  // decodes its input twice
    {"Levels",
     "bake-normals",
     {"a.png", "--out-dir", ".", "--name", "out{level}.png", "--threads", "2", "--mips", "2"},
     ""},
    {"Stream", "pack-normals", {"a.dds", "-o", "out.ktx2", "--format", "bc5", "--threads", "2"}, "a.dds"},
    {"Unpacked", "unpack-normals", {"a.dds", "-o", "out.png", "--threads", "2"}, "a.dds"},
    {"Floats", "unpack-normals", {"a.dds", "-o", "out.exr", "--threads", "2"}, "a.dds"},
    {"Report", "bake-normals", {"a.png", "b.png", "--out-dir", ".", "--name", "out_{stem}.ktx2", "--json"}, ""},
    {"Mended", "repair-normals", {"a.dds", "-o", "out.dds", "--threads", "2"}, "a.dds"},
    {"Picture", "preview-normals", {"a.dds", "-o", "out.png", "--size", "32"}, "a.dds"},
    {"Exr", "mip-normals", {"a.exr", "-o", "out.exr", "--roughness-out", "rough.dds"}, "a.exr"},
    {"Heights", "integrate-normals", {"a.dds", "-o", "out.png", "--curvature-out", "curvature.exr"}, "a.dds"},
    {"Hidden", "bake-normals", {"a.png", "-o", "out.png", "--occlusion-out", "ao.exr", "--horizon-out", "hor.png"}, ""},
    {"OtherReader", "bake-normals", {"a.tif", "-o", "out.dds"}, "a.tif", true},
    {"Model", "pack-normals", {"a.gltf", "-o", "out.gltf", "--y", "down"}, "a.gltf"},
    {"OneFile", "pack-normals", {"a.gltf", "-o", "out.glb", "--y", "down"}, "a.gltf"},
    {"Tangents", "convert-normals", {"a.gltf", "-o", "out.gltf", "--tangents", "mikktspace"}, "a.gltf"},
    {"Lod",
     "transfer-normals",
     {"a.gltf", "high.obj", "-o", "out.gltf", "--extent", "8", "--occlusion-into", "model", "--rays-per-hit", "1"},
     "a.gltf"},
    {"OtherWriter", "unpack-normals", {"a.dds", "-o", "out.tif"}, "a.dds", true},
};

// What stands in the place of an output. Files beside a model are replaced if the old model names them.
std::string old_of(const std::string& name) {
    const bool is_model = name.ends_with(".gltf");
    return is_model ? R"({"asset":{"version":"2.0"},"images":[{"uri":"out_n.png"},{"uri":"out_occlusion_0.png"}],)"
                      R"("buffers":[{"uri":"out_square.bin"}]})"
                    : "the old file";
}

// Installs a copy of a command (with libtex, if it is shared) in its own folder, where the reader process is the shell
// script `reader`. libtex looks for its reader in its own folder. Returns the path of the copy.
std::string install(const Scratch& folder, const std::string& command, const std::string& reader) {
    for (const char* name : {"bin", "lib", "libexec", "libexec/libtex"})
        std::filesystem::create_directory(folder.path(name));
    const std::string program = folder.path("bin/" + command), script = "libexec/libtex/tex-reader";
    std::filesystem::copy_file(std::filesystem::path(TEX_BINARY_DIR) / command, program);
    const std::filesystem::path library = TEX_BINARY_DIR "/libtex.so.1";
    if (std::filesystem::exists(library)) std::filesystem::copy_file(library, folder.path("lib/libtex.so.1"));
    folder.write(script, "#!/bin/sh\n" + reader);
    std::filesystem::permissions(folder.path(script), std::filesystem::perms::owner_all);
    return program;
}

// For such a script: writes the answer of the real reader to `answer`.
std::string ask_the_reader(const std::string& answer) {
    return fmt::format("{} $1 $2 $3 $4 $5 $$ 3<>{} 5>/dev/null", TEX_BINARY_DIR "/tex-reader", answer);
}

class Faults : public testing::TestWithParam<Case> {
protected:
    Faults() {
        for (const char* name : {"a.png", "b.png"}) scratch_.add_sample("ramp.png", name);
        if (*GetParam().input != '\0') make_input("a.png", scratch_.path(GetParam().input));
        for (const std::string& name : scratch_.list()) inputs_[name] = scratch_.read(name);
        outputs_ = make_outputs();
    }

    void make_input(const std::string& from, const std::string& to) {
        if (to.ends_with(".gltf")) {  // with its picture beside it
            scratch_.write(std::filesystem::path(to).filename(),
                           R"({"asset":{"version":"2.0","generator":")" + from +
                               R"("},"images":[{"uri":"n.png"}],"textures":[{"source":0}],)"
                               R"("materials":[{"normalTexture":{"index":0}}])" +
                               square_beside());
            scratch_.write("high.obj", kSheetObj);
            return scratch_.has("n.png") ? void() : make_input("a.png", scratch_.path("n.png"));
        }
        const Ran ran = run(scratch_, "bake-normals",
                            {from, "-o", to, "--format", to.ends_with(".exr") ? "half" : "rgb8", "--no-sync"});
        if (ran.code != 0) throw std::runtime_error(ran.err);
    }
    // The rest of a model that is a square, whose bytes are in a file.
    std::string square_beside() {
        GltfMaker maker;
        maker.add(std::vector<float>{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, "VEC3", 5126);
        maker.add(std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", 5126);
        maker.add(std::vector<float>{0, 1, 1, 1, 1, 0, 0, 0}, "VEC2", 5126);
        maker.add(std::vector<std::uint16_t>{0, 1, 2, 0, 2, 3}, "SCALAR", 5123);
        maker.uri = R"("uri":"square.bin",)";
        scratch_.write("square.bin", maker.binary);
        const std::string text =
            maker.json(R"({"attributes":{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2},"indices":3,"material":0})");
        return "," + text.substr(text.find("\"buffers\""));
    }
    // The outputs of an undisturbed run.
    std::map<std::string, std::string> make_outputs() {
        const Ran ran = run_with({});
        EXPECT_EQ(ran.code, 0) << ran.err;
        std::map<std::string, std::string> made;
        for (const std::string& name : scratch_.list()) {
            if (!inputs_.contains(name)) made[name] = scratch_.read(name);
        }
        return made;
    }

    // From now on the reader process is a script that gives the real reader's answer, which is computed once. The
    // command makes the same calls, and each run takes a tenth of the time.
    void use_a_quick_reader() {
        if (!GetParam().needs_reader) return;
        program_ =
            install(counts_, GetParam().command,
                    fmt::format("[ -e {0} ] || {{ {1}; /bin/mv {0}.new {0}; }}\n/bin/cat {0} >&3; printf x >&5\n",
                                counts_.path("answer"), ask_the_reader(counts_.path("answer.new"))));
        EXPECT_EQ(make_outputs(), outputs_);
        EXPECT_TRUE(counts_.has("answer"));
    }

    // The variables have the form "AT=3".
    Ran run_with(const std::vector<std::string>& variables, int kill_after_us = -1, int signal = SIGKILL) {
        counts_.write("calls", std::string(sizeof(int), '\0'));
        Setting setting;
        setting.environment = {"LD_PRELOAD=" TEX_BINARY_DIR "/faults.so", "TEX_FAULT_COUNT=" + counts_.path("calls"),
                               "LD_LIBRARY_PATH=" + counts_.path("lib")};
        for (const std::string& variable : variables) setting.environment.push_back("TEX_FAULT_" + variable);
        if (kill_after_us >= 0) {
            setting.signal = signal;
            setting.interrupt_after_us = kill_after_us;
        }
        return run(scratch_, program_, GetParam().arguments, setting);
    }
    [[nodiscard]] int calls() const {
        int count = 0;
        std::memcpy(&count, counts_.read("calls").data(), sizeof count);
        return count;
    }

    void put_old_files(bool exist) {
        for (const auto& [name, text] : outputs_) {
            std::filesystem::remove(scratch_.path(name));
            if (exist) scratch_.write(name, old_of(name));
        }
    }

    static bool is_argument(const std::string& name) {
        return std::find(GetParam().arguments.begin(), GetParam().arguments.end(), name) != GetParam().arguments.end();
    }

    // The number of files that should not exist.
    int count_strangers() {
        int strangers = 0;
        for (const std::string& name : scratch_.list())
            strangers += !inputs_.contains(name) && !outputs_.contains(name);
        return strangers;
    }

    // A model and the files beside it are all complete before the first one takes its place.
    [[nodiscard]] int most_strangers() const { return std::max(2, static_cast<int>(outputs_.size())); }

    // Every output must be the old file or the new one.
    void expect_whole(bool exist, bool done) {
        for (const auto& [name, text] : outputs_) {
            const std::string now = scratch_.has(name) ? scratch_.read(name) : "";
            const bool is_old = exist ? now == old_of(name) : !scratch_.has(name);
            EXPECT_TRUE(done ? now == text : now == text || is_old) << name << ": " << now.size() << " bytes";
        }
        for (const auto& [name, text] : inputs_) EXPECT_EQ(scratch_.read(name), text) << name;
    }

    Scratch scratch_, counts_;
    std::string program_ = GetParam().command;
    std::map<std::string, std::string> inputs_, outputs_;
};

TEST_P(Faults, AFailureAtAnyCallLosesNothing) {
    use_a_quick_reader();
    int failed = 0;
    for (const bool exist : {true, false}) {
        for (int n = 1;; ++n) {
            const int error = n % 2 == 0 ? EIO : exist ? ENOSPC : EDQUOT;
            SCOPED_TRACE(testing::Message() << "call " << n << ", " << strerror(error) << ", outputs exist: " << exist);
            put_old_files(exist);
            const Ran ran = run_with(
                {fmt::format("AT={}", n), fmt::format("ERRNO={}", error), fmt::format("NO_TMPFILE={}", n / 2 % 2)});
            const bool reached = calls() >= n;
            ASSERT_TRUE(ran.code == 0 || ran.code == 3 || (reached && ran.code == 4)) << ran.code << "\n" << ran.err;
            expect_whole(exist, ran.code == 0);
            EXPECT_EQ(count_strangers(), 0);
            failed += ran.code != 0;
            if (!reached) break;
        }
    }
    EXPECT_GT(failed, 3);
}

// Kills the process at the n-th call. The next run must remove everything that is left behind.
TEST_P(Faults, DeathAtAnyCallLosesNothing) {
    use_a_quick_reader();
    for (const bool exist : {true, false}) {
        for (int n = exist ? 1 : 2;; n += 2) {
            SCOPED_TRACE(testing::Message() << "call " << n << ", outputs exist: " << exist);
            put_old_files(exist);
            const Ran ran = run_with({fmt::format("AT={}", n), "KILL=1", fmt::format("NO_TMPFILE={}", n / 2 % 2)});
            const bool reached = calls() >= n;
            ASSERT_EQ(ran.code, reached ? 128 + SIGKILL : 0) << ran.err;
            expect_whole(exist, !reached);
            EXPECT_LE(count_strangers(), most_strangers());
            if (!reached) break;
        }
    }
    put_old_files(true);
    ASSERT_EQ(run_with({"NO_TMPFILE=1"}).code, 0);
    expect_whole(true, true);
    EXPECT_EQ(count_strangers(), 0);
}

// An input that is truncated during the read either counts as damaged or was read before. The command must never end by
// a signal or write half an output.
TEST_P(Faults, AnInputThatShrinksWhileItIsReadIsAnError) {
    const bool is_read_by_reader = std::string_view(GetParam().input) == "a.tif";
    if (!is_read_by_reader) use_a_quick_reader();
    const int most = is_read_by_reader ? 24 : 60;
    for (const auto& [input, text] : inputs_) {
        if (!is_argument(input)) continue;
        for (int n = 1; n <= most; ++n) {
            SCOPED_TRACE(testing::Message() << input << ", call " << n);
            put_old_files(true);
            const Ran ran = run_with({fmt::format("AT={}", n), "SHORTEN=" + scratch_.path(input)});
            const bool reached = calls() >= n;
            scratch_.write(input, text);
            ASSERT_TRUE(ran.code == 0 || ran.code == 3 || ran.code == 4) << ran.code << "\n" << ran.err;
            expect_whole(true, ran.code == 0);
            EXPECT_EQ(count_strangers(), 0);
            if (!reached) break;
        }
    }
}

// If an input is replaced by renaming, as libtex does, the command reads either the old file or the new one.
TEST_P(Faults, AnInputThatIsReplacedIsTheOldOneOrTheNewOne) {
    const std::string input = GetParam().arguments[0];
    scratch_.add_sample("hemisphere.png", "dome.png");
    input == "a.png" ? scratch_.add_sample("hemisphere.png", "new")
                     : make_input("dome.png", scratch_.path("new." + input));
    const std::string made = input == "a.png" ? "new" : "new." + input;
    const std::string old_text = inputs_[input], new_text = scratch_.read(made);
    for (const std::string& name : {made, std::string("dome.png")}) std::filesystem::remove(scratch_.path(name));
    scratch_.write(input, new_text);
    const auto new_outputs = make_outputs();
    ASSERT_NE(new_outputs, outputs_);
    int news = 0;
    for (int n = 1; n <= (GetParam().needs_reader ? 8 : 60); ++n) {  // readers get an open file
        SCOPED_TRACE(n);
        put_old_files(false);
        scratch_.write(input, old_text);
        counts_.write("by", new_text);
        const Ran ran =
            run_with({fmt::format("AT={}", n), "REPLACE=" + scratch_.path(input), "BY=" + counts_.path("by")});
        ASSERT_EQ(ran.code, 0) << ran.err;
        std::map<std::string, std::string> outputs;
        for (const std::string& name : scratch_.list()) {
            if (!inputs_.contains(name)) outputs[name] = scratch_.read(name);
        }
        EXPECT_TRUE(outputs == outputs_ || outputs == new_outputs);
        news += outputs == new_outputs;
        if (calls() < n) break;
    }
    EXPECT_GT(news, 0);
}

TEST_P(Faults, DeathAtAnyMomentLosesNothing) {
    const auto start = std::chrono::steady_clock::now();
    ASSERT_EQ(run_with({}).code, 0);
    const auto whole =
        std::chrono::duration_cast<std::chrono::microseconds>(std::chrono::steady_clock::now() - start).count();
    std::minstd_rand random(11);
    const int rounds = GetParam().needs_reader ? 10 : 40;  // at least 200 in total
    for (int round = 0; round < rounds; ++round) {
        SCOPED_TRACE(round);
        put_old_files(true);
        const auto after = static_cast<int>(random() % static_cast<unsigned long>(whole + whole / 8));
        const Ran ran = run_with({fmt::format("NO_TMPFILE={}", round % 2)}, after);
        ASSERT_TRUE(ran.code == 0 || ran.code == 128 + SIGKILL) << ran.code << "\n" << ran.err;
        expect_whole(true, ran.code == 0);
        EXPECT_LE(count_strangers(), most_strangers());
    }
    ASSERT_EQ(run_with({"NO_TMPFILE=1"}).code, 0);
    EXPECT_EQ(count_strangers(), 0);
}

TEST_P(Faults, ASignalAtAnyMomentLeavesNothing) {
    const auto start = std::chrono::steady_clock::now();
    ASSERT_EQ(run_with({}).code, 0);
    const auto whole =
        std::chrono::duration_cast<std::chrono::microseconds>(std::chrono::steady_clock::now() - start).count();
    std::minstd_rand random(12);
    const int rounds = GetParam().needs_reader ? 2 : 10;
    for (int round = 0; round < rounds; ++round) {
        SCOPED_TRACE(round);
        put_old_files(true);
        const auto after = static_cast<int>(random() % static_cast<unsigned long>(whole));
        const Ran ran = run_with({"NO_TMPFILE=1"}, after, round % 4 < 2 ? SIGINT : SIGTERM);
        ASSERT_TRUE(ran.code == 0 || ran.code == 128 + SIGINT || ran.code == 128 + SIGTERM) << ran.code << "\n"
                                                                                            << ran.err;
        expect_whole(true, ran.code == 0);
        EXPECT_EQ(count_strangers(), 0);
    }
}

// While the command waits for a decoder, nothing unwinds its stack. So the signal's handler removes files: after its
// timeout, or at a second signal.
TEST(FaultsOfReaders, ASignalWhileAReaderHangsLeavesNothing) {
    for (const bool twice : {false, true}) {
        SCOPED_TRACE(twice);
        const Scratch scratch, programs;
        scratch.add_sample("ramp.png", "a.png");
        ASSERT_EQ(run(scratch, "bake-normals", {"a.png", "-o", "a.tif", "--format", "rgb8", "--no-sync"}).code, 0);
        scratch.write("out.dds", old_of("out.dds"));
        const std::vector<std::string> before = scratch.list();
        // The script reports one row of all that the header promises; `state` and `rows_done` are at 4 and 40
        // (reader_protocol.h). It sends the signal once the output has been begun, and then does nothing.
        const std::string patch = "\\0\\0\\0' | /bin/dd of=/proc/self/fd/3 bs=1 conv=notrunc seek=";
        const std::string wait = "/bin/sleep 0.02; k=$((k + 1)); done; ";
        const std::string program =
            install(programs, "bake-normals",
                    ask_the_reader(programs.path("answer")) + "\n/bin/cat " + programs.path("answer") +
                        " >&3; printf '\\0" + patch + "4; printf '\\1" + patch +
                        "40; printf x >&5\nk=0; until [ -e .out.dds.tex-tmp0 -o $k = 500 ]; do " + wait +
                        "[ $k = 500 ] || : >" + programs.path("begun") + "\nkill -TERM $6; " +
                        (twice ? "/bin/sleep 0.1; kill -TERM $6; " : "") +
                        "k=0; while [ $k != 500 ] && kill -0 $6; do " + wait);
        Setting setting;
        setting.environment = {"LD_PRELOAD=" TEX_BINARY_DIR "/faults.so", "TEX_FAULT_NO_TMPFILE=1",
                               "LD_LIBRARY_PATH=" + programs.path("lib")};
        const Ran ran = run(scratch, program, {"a.tif", "-o", "out.dds"}, setting);
        EXPECT_EQ(ran.code, 128 + SIGTERM) << ran.err;
        EXPECT_TRUE(programs.has("begun"));
        EXPECT_EQ(scratch.list(), before);
        EXPECT_EQ(scratch.read("out.dds"), old_of("out.dds"));
    }
}

TEST_P(Faults, WithoutThreadsTheBytesAreTheSame) {
    put_old_files(true);
    const Ran ran = run_with({"THREADS=0"});
    EXPECT_EQ(ran.code, 0) << ran.err;
    expect_whole(true, true);
}

// Threads that could start when the command tried, but are refused when TBB needs them (which throws), because other
// processes have reached a limit of processes in the meantime.
TEST(FaultsOfThreads, ThoseThatAreRefusedLaterAreOneSentence) {
    const Scratch scratch;
    for (const char* name : {"strip.png", "waves.png"}) scratch.add_sample(name, name);
    ASSERT_EQ(shell(scratch, "bake-normals strip.png -o strip.dds --no-sync --effort fast").code, 0);
    const std::vector<std::string> lines[] = {
        {"bake-normals", "strip.png", "-o", "out.dds", "--effort", "fast"},                    // one stream
        {"pack-normals", "strip.dds", "-o", "out.ktx2", "--effort", "fast"},                   // another stream
        {"bake-normals", "strip.png", "-o", "out.dds", "--effort", "fast", "--fill-invalid"},  // the whole height map
        {"bake-normals", "strip.png", "waves.png", "--name", "out.{stem}.dds", "--effort",
         "fast"},  // two files at once
    };
    for (const std::vector<std::string>& line : lines) {
        std::vector<std::string> arguments(line.begin() + 1, line.end());
        arguments.insert(arguments.end(), {"--no-sync", "--threads", "2"});
        const std::vector<std::string> before = scratch.list();
        int refused = 0;
        for (int threads = 1, done = 0; done < 2; ++threads) {
            SCOPED_TRACE(testing::Message() << line[0] << " " << line[3] << ", " << threads);
            ASSERT_LT(threads, 4096);
            Setting setting;
            setting.environment = {"LD_PRELOAD=" TEX_BINARY_DIR "/faults.so",
                                   fmt::format("TEX_FAULT_THREADS={}", threads)};
            const Ran ran = run(scratch, line[0], arguments, setting);
            done = ran.code == 0 ? done + 1 : 0;
            if (ran.code == 0) continue;
            ++refused;
            EXPECT_EQ(ran.code, 3);
            EXPECT_TRUE(ran.err.find("the system refuses threads") != std::string::npos &&
                        std::count(ran.err.begin(), ran.err.end(), '\n') == 1)
                << ran.err;
            EXPECT_EQ(scratch.list(), before);
        }
        EXPECT_GT(refused, 0) << line[0] << " " << line[3];
        for (const char* name : {"out.dds", "out.ktx2", "out.strip.dds", "out.waves.dds"})
            std::filesystem::remove(scratch.path(name));
    }
}

// The one file that a command reads and replaces: it is read whole before, so it is the old one or the new one.
TEST(FaultsInPlace, ATextureThatGetsRoughnessIsTheOldOneOrTheNewOne) {
    const Scratch scratch, counts;
    scratch.add_sample("ramp.png", "h.png");
    ASSERT_EQ(
        shell(scratch,
              "bake-normals h.png -o n.exr --format half --no-sync && bake-normals h.png -o orm.dds --format rgba8 "
              "--bumpiness 3 --mips none --no-sync && cp orm.dds old")
            .code,
        0);
    const std::string old = scratch.read("old");
    const auto go = [&](int at, bool kills) {
        counts.write("calls", std::string(sizeof(int), '\0'));
        Setting setting;
        setting.environment = {"LD_PRELOAD=" TEX_BINARY_DIR "/faults.so", "TEX_FAULT_COUNT=" + counts.path("calls"),
                               fmt::format("TEX_FAULT_AT={}", at), fmt::format("TEX_FAULT_NO_TMPFILE={}", at / 2 % 2)};
        setting.environment.push_back(kills ? "TEX_FAULT_KILL=1" : fmt::format("TEX_FAULT_ERRNO={}", EIO));
        return run(scratch, "mip-normals", {"n.exr", "-o", "out.dds", "--roughness-into", "orm.dds:g"}, setting);
    };
    ASSERT_EQ(go(1 << 20, false).code, 0);
    const std::string made = scratch.read("orm.dds");
    ASSERT_NE(made, old);
    int failed = 0;
    for (const bool kills : {false, true}) {
        for (int n = 1;; n += kills ? 3 : 1) {
            SCOPED_TRACE(testing::Message() << "call " << n << (kills ? ", killed" : ""));
            scratch.write("orm.dds", old);
            const Ran ran = go(n, kills);
            int calls = 0;
            std::memcpy(&calls, counts.read("calls").data(), sizeof calls);
            const std::string now = scratch.read("orm.dds");
            EXPECT_TRUE(now == made || (ran.code != 0 && now == old)) << now.size() << " bytes";
            failed += ran.code != 0;
            if (calls < n) break;
        }
    }
    EXPECT_GT(failed, 10);
}

INSTANTIATE_TEST_SUITE_P(Cases, Faults, testing::ValuesIn(kCases),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace tex::cli
