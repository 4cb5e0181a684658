// SPDX-License-Identifier: Apache-2.0
// Commands as objects: run() in this process, repeatedly and from several threads at once, does the same as the
// programs.

#include <csignal>
#include <regex>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "cli/host.h"
#include "cli/program.h"
#include "cli/programs.h"

namespace tex::cli {
namespace {

struct Line {
    const char* program;
    std::vector<std::string> arguments;  // IN and OUT are folders
    std::vector<std::string> outputs;    // in OUT
};

const Line kLines[] = {
    {"bake-normals",
     {"IN/ramp.png", "IN/waves.png", "--out-dir", "OUT", "--bumpiness", "6", "--json"},
     {"ramp.dds", "waves.dds"}},
    {"bake-normals", {"IN/color.png", "IN/none.png", "--out-dir", "OUT", "--name", "{stem}.png"}, {"color.png"}},
    {"pack-normals", {"IN/n.png", "-o", "OUT/n.ktx2", "--format", "bc5", "--threads", "2"}, {"n.ktx2"}},
    {"pack-normals", {"IN/n.png", "-o", "OUT/quiet.dds", "--quiet", "--mips", "all"}, {"quiet.dds"}},
    {"pack-normals", {"IN/n.png", "-o", "OUT/n.dds", "--formt", "bc5"}, {}},
    {"check-normals",
     {"IN/n.png", "IN/ramp.png", "--sarif", "OUT/a.sarif", "--junit", "OUT/a.xml"},
     {"a.sarif", "a.xml"}},
    {"check-normals", {"IN/none.png", "--json"}, {}},
    {"check-normals", {"--list"}, {}},
    {"compare-normals", {"IN/n.png", "IN/n.png", "--max", "0"}, {}},
    {"bake-normals", {"--help"}, {}},
};

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
        text.replace(at, from.size(), to);
    return text;
}

}  // namespace

class InProcess : public testing::Test {
protected:
    InProcess() {
        std::filesystem::create_directory(scratch_.path("in"));
        for (const char* name : {"ramp.png", "waves.png"}) scratch_.add_sample(name, fmt::format("in/{}", name));
        const Ran made = shell(scratch_,
                               "convert in/ramp.png -colorspace sRGB -fill red -colorize 30 in/color.png; "
                               "bake-normals in/waves.png -o in/n.png --bumpiness 4");
        EXPECT_EQ(made.code, 0) << made.err;
    }

    [[nodiscard]] std::vector<std::string> arguments_of(const Line& line, const std::string& out) const {
        std::vector<std::string> arguments;
        for (const std::string& argument : line.arguments)
            arguments.push_back(replaced(replaced(argument, "IN", scratch_.path("in")), "OUT", scratch_.path(out)));
        return arguments;
    }

    // What a run printed and wrote, with the name of its folder removed.
    [[nodiscard]] std::string result_of(const Line& line, const std::string& folder, int code, const std::string& out,
                                        const std::string& err) const {
        std::string text = fmt::format("{}\n{}\n{}", code, without_seconds(out), err);
        for (const std::string& name : line.outputs) {
            text += "\n" + std::regex_replace(scratch_.read(folder + "/" + name), std::regex("time=\"[0-9.]+\""), "");
        }
        return replaced(text, scratch_.path(folder), "OUT");
    }

    [[nodiscard]] std::string run_here(const Line& line, const std::string& folder) const {
        std::filesystem::create_directory(scratch_.path(folder));
        const std::vector<std::string> arguments = arguments_of(line, folder);
        std::vector<const char*> pointers;
        for (const std::string& argument : arguments) pointers.push_back(argument.c_str());
        MemoryHost host;
        const ExitCode code = run(*find_program(line.program), pointers, host);
        return result_of(line, folder, static_cast<int>(code), host.out(), host.err());
    }

    Scratch scratch_;
};

TEST_F(InProcess, TheTableHoldsEveryCommand) {
    std::vector<std::string> names;
    for (const ProgramRow& row : programs()) names.emplace_back(row.name);
    EXPECT_EQ(names, commands());
    EXPECT_EQ(find_program("nonsense-normals"), nullptr);
}

TEST_F(InProcess, ThreadsRunCommandsAsTheirProgramsDo) {
    std::vector<std::string> expected;
    for (const Line& line : kLines) {
        const std::string folder = fmt::format("program{}", expected.size());
        std::filesystem::create_directory(scratch_.path(folder));
        const Ran ran = run(scratch_, line.program, arguments_of(line, folder));
        expected.push_back(result_of(line, folder, ran.code, ran.out, ran.err));
    }
    constexpr std::size_t kThreads = 4, kRounds = 2, kCount = std::size(kLines);
    std::vector<std::vector<std::string>> results(kThreads);
    std::vector<std::thread> threads;
    for (std::size_t t = 0; t < kThreads; ++t) {
        threads.emplace_back([&, t] {
            for (std::size_t k = 0; k < kRounds * kCount; ++k)  // each thread begins with a different line
                results[t].push_back(run_here(kLines[(k + t) % kCount], fmt::format("thread{}-{}", t, k)));
        });
    }
    for (std::thread& thread : threads) thread.join();
    for (std::size_t t = 0; t < kThreads; ++t) {
        for (std::size_t k = 0; k < kRounds * kCount; ++k) {
            const std::size_t line = (k + t) % kCount;
            EXPECT_EQ(results[t][k], expected[line]) << kLines[line].program << ", line " << line;
        }
    }
}

TEST_F(InProcess, AHostStopsARunAndTheProcessGoesOn) {
    class Stopping : public MemoryHost {
    public:
        [[nodiscard]] std::string_view interruption() const override { return "a test"; }
    };
    struct sigaction before {
    }, after{};
    sigaction(SIGINT, nullptr, &before);
    const std::string input = scratch_.path("in/ramp.png"), output = scratch_.path("x.dds");
    const std::vector<const char*> arguments = {input.c_str(), "-o", output.c_str()};
    Stopping host;
    EXPECT_EQ(run(*find_program("bake-normals"), arguments, host), ExitCode::io);
    EXPECT_EQ(host.err(), "bake-normals: error: interrupted by a test; 0 of 1 files are done\n");
    EXPECT_FALSE(scratch_.has("x.dds"));
    sigaction(SIGINT, nullptr, &after);
    EXPECT_EQ(before.sa_handler, after.sa_handler);
}

}  // namespace tex::cli
