// SPDX-License-Identifier: Apache-2.0
// The same bytes everywhere: every command, on every instruction set that this processor has, with 1, 2, 3 and 8 threads, makes the same files from the samples.
// Where tests/golden/commands.txt is there, the files are those whose hashes it lists, so that compilers and machines are compared, too. That the bytes are right
// is proved elsewhere.
//
//     TEX_GOLDEN_WRITE=1 build/release/cli_tests --gtest_filter='*Matrix*'
//
// writes the list (with the instruction set of the first test, on one thread); where bytes change on purpose, `git diff` tells whose did.

#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <map>
#include <set>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <hwy/targets.h>

#include "cli/program.h"

namespace tex::cli {
namespace {

namespace fs = std::filesystem;

const fs::path kList = fs::path(TEX_SOURCE_DIR) / "tests" / "golden" / "commands.txt";

// A command line; outputs go into a folder of its name, and what it prints counts as an output where it has none.
struct Line {
    const char* name;
    const char* command;
    std::vector<std::string> arguments;
};

const std::vector<std::string> kHeights = {"hemisphere.png", "ramp.png", "strip.png", "waves.png"};
const std::vector<std::string> kMaps = {"maps/hemisphere.png", "maps/ramp.png", "maps/strip.png", "maps/waves.png"};

const Line kLines[] = {
    {"maps", "bake-normals", {"HEIGHTS", "--format", "rgb16", "--container", "png", "--bumpiness", "6"}},
    {"bake", "bake-normals", {"HEIGHTS", "--bumpiness", "6"}},
    {"bake-best", "bake-normals", {"HEIGHTS", "--effort", "best", "--kernel", "scharr", "--wrap", "mirror", "--blur", "2"}},
    {"bake-bc5", "bake-normals", {"HEIGHTS", "--format", "bc5", "--container", "ktx2", "--effort", "fast", "--kernel", "gaussian:2", "--wrap", "clamp"}},
    {"bake-exr", "bake-normals", {"HEIGHTS", "--format", "half", "--container", "exr", "--mips", "all", "--kernel", "sobel5"}},
    {"bake-snorm", "bake-normals", {"waves.png", "--format", "bc5-snorm", "--mip-filter", "kaiser"}},
    {"mip", "mip-normals", {"MAPS", "--format", "float", "--container", "dds", "--mip-filter", "lanczos3", "--fade", "2,5"}},
    {"pack", "pack-normals", {"MAPS", "--format", "rg8", "--container", "ktx2", "--y", "down", "--mips", "3"}},
    {"unpack", "unpack-normals", {"bake/hemisphere.dds", "bake-bc5/waves.ktx2", "--container", "png"}},
    {"scale", "scale-normals", {"MAPS", "--scale", "1.7", "--format", "rgba8"}},
    {"blend", "blend-normals", {"maps/waves.png", "maps/hemisphere.png", "--detail", "maps/ramp.png", "--tiling", "3", "--rotate", "30"}},
    {"preview", "preview-normals", {"maps/waves.png", "maps/hemisphere.png", "--size", "96"}},
    {"check", "check-normals", {"MAPS", "bake/hemisphere.dds", "--json"}},
    {"compare", "compare-normals", {"maps/waves.png", "bake/waves.dds", "--json"}},
};

std::string hash_of(const std::string& bytes) {  // FNV-1a
    std::uint64_t hash = 0xcbf29ce484222325u;
    for (const char c : bytes) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
    return fmt::format("{:016x}", hash);
}

// Name of an output -> hash of its bytes, for all command lines.
using Hashes = std::map<std::string, std::string>;

Hashes run_lines(const std::string& target, int threads) {
    const Scratch scratch;
    for (const std::string& height : kHeights) scratch.add_sample(height, height);
    Hashes hashes;
    for (const Line& line : kLines) {
        std::vector<std::string> arguments;
        for (const std::string& argument : line.arguments) {
            if (argument == "HEIGHTS" || argument == "MAPS") {
                const auto& files = argument == "MAPS" ? kMaps : kHeights;
                arguments.insert(arguments.end(), files.begin(), files.end());
            } else {
                arguments.push_back(argument);
            }
        }
        const bool writes = std::string_view(line.command) != "check-normals" && std::string_view(line.command) != "compare-normals";
        if (writes) arguments.insert(arguments.end(), {"--out-dir", line.name, "--no-sync"});
        arguments.insert(arguments.end(), {"--threads", std::to_string(threads)});
        Setting setting;
        setting.environment = {"LD_PRELOAD=" TEX_BINARY_DIR "/target.so", "TEX_TARGET=" + target};
        const Ran ran = run(scratch, line.command, arguments, setting);
        EXPECT_TRUE(ran.code == 0 || (!writes && ran.code == 1)) << line.name << ": " << ran.code << "\n" << ran.err;
        if (!writes) hashes[fmt::format("{}/stdout", line.name)] = hash_of(ran.out);
        if (!writes || !scratch.has(line.name)) continue;
        for (const auto& entry : fs::directory_iterator(scratch.path(line.name))) {
            const std::string name = fmt::format("{}/{}", line.name, entry.path().filename().string());
            hashes[name] = hash_of(scratch.read(name));
        }
    }
    return hashes;
}

Hashes golden() {
    std::ifstream file(kList);
    Hashes hashes;
    for (std::string hash, name; file >> hash >> name;) hashes[name] = hash;
    return hashes;
}

std::vector<std::string> targets() {
    std::vector<std::string> names;
    for (std::int64_t left = hwy::SupportedTargets(); left != 0; left &= left - 1) names.emplace_back(hwy::TargetName(left & -left));
    return names;
}

class Matrix : public testing::TestWithParam<std::string> {};

TEST_P(Matrix, EveryCommandMakesTheGoldenBytes) {
    if (std::getenv("TEX_GOLDEN_WRITE") != nullptr) {
        static bool written = false;
        if (written) return;
        std::ofstream file(kList);
        for (const auto& [name, hash] : run_lines(GetParam(), 1)) file << hash << " " << name << "\n";
        written = true;
        return;
    }
    const Hashes listed = golden();
    static const Hashes first = run_lines(targets().front(), 1);
    const Hashes& wanted = listed.empty() ? first : listed;
    for (const int threads : {1, 2, 3, 8}) {
        const Hashes hashes = run_lines(GetParam(), threads);
        EXPECT_EQ(hashes.size(), wanted.size());
        for (const auto& [name, hash] : hashes) {
            const auto golden_hash = wanted.find(name);
            EXPECT_TRUE(golden_hash != wanted.end() && golden_hash->second == hash) << name << " with " << threads << " threads has other bytes than "
                                                                          << (listed.empty() ? "with one" : "tests/golden/commands.txt says");
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Targets, Matrix, testing::ValuesIn(targets()));

}  // namespace
}  // namespace tex::cli
