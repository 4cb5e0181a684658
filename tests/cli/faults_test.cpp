// SPDX-License-Identifier: Apache-2.0
// Whatever fails while a command runs, at whatever moment: each output is the old file or the new one, whole, and nothing else stays behind. The commands run under
// tests/preload/faults.cpp. To have another way of writing tested, add its command line to kCases.

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <map>
#include <random>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "cli/program.h"

namespace tex::cli {
namespace {

struct Case {
    const char* name;
    const char* command;
    std::vector<std::string> arguments;
    int most_calls;  // that are made to fail: the first ones; decoders and encoders of other processes take long to come to theirs
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

const Case kCases[] = {
    {"Texture", "bake-normals", {"a.png", "-o", "out.dds", "--threads", "2"}, 1000},
    {"Levels", "bake-normals", {"a.png", "--out-dir", ".", "--name", "out{level}.png", "--threads", "2", "--mips", "2"}, 1000},
    {"Report", "bake-normals", {"a.png", "b.png", "--out-dir", ".", "--name", "out_{stem}.ktx2", "--json"}, 1000},
    {"Picture", "preview-normals", {"a.dds", "-o", "out.png", "--size", "32"}, 1000},
    {"Exr", "mip-normals", {"a.exr", "-o", "out.exr"}, 1000},
    {"OtherReader", "bake-normals", {"a.tif", "-o", "out.dds"}, 24},
    {"OtherWriter", "unpack-normals", {"a.dds", "-o", "out.tif"}, 24},
};

const std::string kOld = "the old file";

class Faults : public testing::TestWithParam<Case> {
protected:
    Faults() {
        for (const char* name : {"a.png", "b.png"}) scratch_.add_sample("ramp.png", name);
        for (const char* made : {"a.dds", "a.exr", "a.tif"}) {
            if (run(scratch_, "bake-normals", {"a.png", "-o", made, "--format", std::string_view(made) == "a.exr" ? "half" : "rgb8", "--no-sync"}).code != 0) throw std::runtime_error(made);
        }
        for (const std::string& name : scratch_.list()) inputs_[name] = scratch_.read(name);
        const Ran ran = run_with({});
        EXPECT_EQ(ran.code, 0) << ran.err;
        for (const std::string& name : scratch_.list()) {
            if (!inputs_.contains(name)) outputs_[name] = scratch_.read(name);
        }
    }

    // Variables as "AT=3".
    Ran run_with(const std::vector<std::string>& variables, int kill_after_us = -1) {
        counts_.write("calls", std::string(sizeof(int), '\0'));
        Setting setting;
        setting.environment = {"LD_PRELOAD=" TEX_BINARY_DIR "/faults.so", "TEX_FAULT_COUNT=" + counts_.path("calls")};
        for (const std::string& variable : variables) setting.environment.push_back("TEX_FAULT_" + variable);
        if (kill_after_us >= 0) {
            setting.signal = SIGKILL;
            setting.interrupt_after_us = kill_after_us;
        }
        return run(scratch_, GetParam().command, GetParam().arguments, setting);
    }
    [[nodiscard]] int calls() const {
        int count = 0;
        std::memcpy(&count, counts_.read("calls").data(), sizeof count);
        return count;
    }

    void put_old_files(bool exist) {
        for (const auto& [name, text] : outputs_) {
            exist ? scratch_.write(name, kOld) : void(std::filesystem::remove(scratch_.path(name)));
        }
    }

    // How many files there are that should not be.
    int count_strangers() {
        int strangers = 0;
        for (const std::string& name : scratch_.list()) strangers += !inputs_.contains(name) && !outputs_.contains(name);
        return strangers;
    }

    // Every output is the old file or the new one.
    void expect_whole(bool exist, bool done) {
        for (const auto& [name, text] : outputs_) {
            const std::string now = scratch_.has(name) ? scratch_.read(name) : "";
            const bool is_old = exist ? now == kOld : !scratch_.has(name);
            EXPECT_TRUE(done ? now == text : now == text || is_old) << name << ": " << now.size() << " bytes";
        }
        for (const auto& [name, text] : inputs_) EXPECT_EQ(scratch_.read(name), text) << name;
    }

    Scratch scratch_, counts_;
    std::map<std::string, std::string> inputs_, outputs_;
};

TEST_P(Faults, AFailureAtAnyCallLosesNothing) {
    int failed = 0;
    for (const bool exist : {true, false}) {
        for (int n = 1; n <= GetParam().most_calls; ++n) {
            const int error = n % 2 == 0 ? EIO : exist ? ENOSPC : EDQUOT;
            SCOPED_TRACE(testing::Message() << "call " << n << ", " << strerror(error) << ", outputs exist: " << exist);
            put_old_files(exist);
            const Ran ran = run_with({fmt::format("AT={}", n), fmt::format("ERRNO={}", error), fmt::format("NO_TMPFILE={}", n / 2 % 2)});
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

// Death at the n-th call: what it leaves behind is gone after the next run.
TEST_P(Faults, DeathAtAnyCallLosesNothing) {
    for (const bool exist : {true, false}) {
        for (int n = exist ? 1 : 2; n <= GetParam().most_calls; n += 2) {
            SCOPED_TRACE(testing::Message() << "call " << n << ", outputs exist: " << exist);
            put_old_files(exist);
            const Ran ran = run_with({fmt::format("AT={}", n), "KILL=1", fmt::format("NO_TMPFILE={}", n / 2 % 2)});
            const bool reached = calls() >= n;
            ASSERT_EQ(ran.code, reached ? 128 + SIGKILL : 0) << ran.err;
            expect_whole(exist, !reached);
            EXPECT_LE(count_strangers(), 2);
            if (!reached) break;
        }
    }
    put_old_files(true);
    ASSERT_EQ(run_with({"NO_TMPFILE=1"}).code, 0);
    expect_whole(true, true);
    EXPECT_EQ(count_strangers(), 0);
}

// An input that somebody empties while it is read is damaged, or was read before: never a signal, never half an output.
TEST_P(Faults, AnInputThatShrinksWhileItIsReadIsAnError) {
    for (const auto& [input, text] : inputs_) {
        if (std::find(GetParam().arguments.begin(), GetParam().arguments.end(), input) == GetParam().arguments.end()) continue;
        for (int n = 1; n <= std::min(GetParam().most_calls, 60); ++n) {
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

TEST_P(Faults, DeathAtAnyMomentLosesNothing) {
    const auto start = std::chrono::steady_clock::now();
    ASSERT_EQ(run_with({}).code, 0);
    const auto whole = std::chrono::duration_cast<std::chrono::microseconds>(std::chrono::steady_clock::now() - start).count();
    std::minstd_rand random(11);
    const int rounds = GetParam().most_calls < 1000 ? 10 : 40;  // 200 and more together
    for (int round = 0; round < rounds; ++round) {
        SCOPED_TRACE(round);
        put_old_files(true);
        const auto after = static_cast<int>(random() % static_cast<unsigned long>(whole + whole / 8));
        const Ran ran = run_with({fmt::format("NO_TMPFILE={}", round % 2)}, after);
        ASSERT_TRUE(ran.code == 0 || ran.code == 128 + SIGKILL) << ran.code << "\n" << ran.err;
        expect_whole(true, ran.code == 0);
        EXPECT_LE(count_strangers(), 2);
    }
    ASSERT_EQ(run_with({"NO_TMPFILE=1"}).code, 0);
    EXPECT_EQ(count_strangers(), 0);
}

TEST_P(Faults, WithoutThreadsTheBytesAreTheSame) {
    put_old_files(true);
    const Ran ran = run_with({"NO_THREADS=1"});
    EXPECT_EQ(ran.code, 0) << ran.err;
    expect_whole(true, true);
}

INSTANTIATE_TEST_SUITE_P(Cases, Faults, testing::ValuesIn(kCases), [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace tex::cli
