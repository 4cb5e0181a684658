// SPDX-License-Identifier: Apache-2.0
// The same bytes everywhere: every command makes the same files from the samples on every instruction set that this
// processor has, with 1, 2, 3 and 8 threads. If tests/golden/commands.txt exists, the files must have the hashes that
// it lists, so that compilers and machines are compared, too. Other tests prove that the bytes are right.
//
// The largest sample and the height maps in ../shared/data (if they exist) take longer, so they run once with each
// instruction set, with a different number of threads each time. They are baked with a few rows in memory and, with
// --fill-invalid, with all heights in memory; the bytes must be the same.
//
//     TEX_GOLDEN_WRITE=1 build/release/cli_tests --gtest_filter='*Matrix*'
//
// writes the list (with the instruction set of the first test, on one thread). If bytes change on purpose, `git diff`
// shows which commands are affected.

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <map>
#include <set>
#include <span>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <hwy/targets.h>

#include "cli/meshes.h"
#include "cli/plain_exr.h"
#include "cli/program.h"

namespace tex::cli {
namespace {

namespace fs = std::filesystem;

const fs::path kList = fs::path(TEX_SOURCE_DIR) / "tests" / "golden" / "commands.txt";

// A command line. Its outputs go into a folder with its name. If it has no output, its printed text counts as one.
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
    {"bake-best",
     "bake-normals",
     {"HEIGHTS", "--effort", "best", "--kernel", "scharr", "--wrap", "mirror", "--blur", "2"}},
    {"bake-bc5",
     "bake-normals",
     {"HEIGHTS", "--format", "bc5", "--container", "ktx2", "--effort", "fast", "--kernel", "gaussian:2", "--wrap",
      "clamp"}},
    {"bake-exr",
     "bake-normals",
     {"HEIGHTS", "--format", "half", "--container", "exr", "--mips", "all", "--kernel", "sobel5"}},
    {"bake-eac", "bake-normals", {"HEIGHTS", "--format", "eac-rg11", "--container", "ktx2", "--bumpiness", "6"}},
    {"bake-eac-best",
     "bake-normals",
     {"ramp.png", "waves.png", "--format", "eac-rg11-snorm", "--container", "ktx2", "--effort", "best"}},
    {"bake-eac-fast",
     "bake-normals",
     {"strip.png", "waves.png", "--format", "eac-rg11", "--container", "ktx2", "--effort", "fast", "--wrap", "clamp"}},
    {"bake-astc", "bake-normals", {"waves.png", "--format", "astc-6x6", "--container", "ktx2", "--bumpiness", "6"}},
    {"bake-astc-fast",
     "bake-normals",
     {"hemisphere.png", "ramp.png", "--format", "astc-8x5", "--container", "ktx2", "--effort", "fast"}},
    {"bake-astc-file", "bake-normals", {"strip.png", "--container", "astc", "--effort", "best"}},
    {"bake-rdo",
     "bake-normals",
     {"ramp.png", "waves.png", "--format", "bc5", "--container", "ktx2", "--rdo-mean", "0.5"}},
    {"bake-snorm", "bake-normals", {"waves.png", "--format", "bc5-snorm", "--mip-filter", "kaiser"}},
    {"mip",
     "mip-normals",
     {"MAPS", "--format", "float", "--container", "dds", "--mip-filter", "lanczos3", "--fade", "2,5"}},
    {"pack", "pack-normals", {"MAPS", "--format", "rg8", "--container", "ktx2", "--y", "down", "--mips", "3"}},
    {"unpack", "unpack-normals", {"bake/hemisphere.dds", "bake-bc5/waves.ktx2", "--container", "png"}},
    {"scale", "scale-normals", {"MAPS", "--scale", "1.7", "--format", "rgba8"}},
    {"blend",
     "blend-normals",
     {"maps/waves.png", "maps/hemisphere.png", "--detail", "maps/ramp.png", "--tiling", "3", "--rotate", "30"}},
    {"convert",
     "convert-normals",
     {"MAPS", "--mesh", "sheet.obj", "--decoder-in", "godot", "--decoder", "three", "--format", "rgb16"}},
    {"convert-object",
     "convert-normals",
     {"maps/waves.png", "--mesh", "sheet.obj", "--to", "object", "--container", "dds", "--tangents", "meshopt"}},
    {"integrate",
     "integrate-normals",
     {"MAPS", "--wrap", "clamp,repeat", "--container", "png", "--curvature-out", "{stem}_c.png"}},
    {"integrate-blocks", "integrate-normals", {"bake/hemisphere.dds", "--container", "exr", "--curl-out", "curl.png"}},
    {"transfer",
     "transfer-normals",
     {"crate_low.glb", "--high", "crate_high.glb", "--extent", "128", "--subsamples", "2", "--rays", "straight",
      "--height-out", "{stem}_h.exr", "--object-out", "{stem}_o.png", "--position-out", "{stem}_p.exr"}},
    {"transfer-nearest",
     "transfer-normals",
     {"crate_low.glb", "--high", "crate_high.glb", "--extent", "96x64", "--hit", "nearest", "--container", "png",
      "--decoder", "three", "--padding", "2"}},
    {"preview", "preview-normals", {"maps/waves.png", "maps/hemisphere.png", "--size", "96"}},
    {"check", "check-normals", {"MAPS", "bake/hemisphere.dds", "--json"}},
    {"compare", "compare-normals", {"maps/waves.png", "bake/waves.dds", "--json"}},
};

// REAL stands for all real height maps except the files named after it. If there are no real maps, REAL and the names
// after it are left out.
const Line kLargeLines[] = {
    {"large",
     "bake-normals",
     {"bricks.png", "--bumpiness", "12", "--effort", "fast", "REAL", "canyon_4096x4096_rgb8_equal.jpg",
      "dtm_283x259_f32_nodata-9999.tif", "reader_nan_inf_800x800.exr"}},
    {"large-whole",
     "bake-normals",
     {"bricks.png", "--bumpiness", "12", "--effort", "fast", "--fill-invalid", "--no-data=-9999", "REAL",
      "canyon_4096x4096_rgb8_equal.jpg"}},
    {"large-bake", "bake-normals", {"bricks.png", "--format", "float", "--container", "exr", "--bumpiness", "12"}},
    {"large-mip",
     "mip-normals",
     {"large-bake/bricks.exr", "--format", "bc5", "--container", "dds", "--mip-filter", "kaiser"}},
    {"large-pack", "pack-normals", {"large-bake/bricks.exr", "--container", "ktx2"}},
    {"large-unpack", "unpack-normals", {"large/bricks.dds", "--container", "png"}},
    {"large-scale",
     "scale-normals",
     {"large-bake/bricks.exr", "--scale", "0.3", "--format", "rgb16", "--container", "png"}},
    {"large-blend",
     "blend-normals",
     {"large-bake/bricks.exr", "--detail", "maps/waves.png", "--tiling", "7", "--format", "rgb16", "--container",
      "png"}},
    {"large-convert",
     "convert-normals",
     {"large-bake/bricks.exr", "--mesh", "sheet.obj", "--to", "object", "--padding", "9"}},
    {"large-integrate", "integrate-normals", {"large-bake/bricks.exr", "--container", "png", "--kernel", "sobel"}},
    {"large-preview", "preview-normals", {"large/bricks.dds", "--shape", "sphere", "--size", "96"}},
    {"large-check", "check-normals", {"large/bricks.dds", "--json"}},
    {"large-compare", "compare-normals", {"large-bake/bricks.exr", "large/bricks.dds", "--json"}},
};
constexpr int kThreads[] = {1, 2, 3, 8};

// Programs of another machine, which tests/arm64.sh runs under QEMU, choose their instruction set themselves. They have
// no reader process.
const std::string kEmulated = "emulated";
bool is_emulated() { return std::getenv("TEX_PROGRAMS") != nullptr; }

const fs::path kReal = fs::path(TEX_SOURCE_DIR) / ".." / "shared" / "data" / "height";

std::string hash_of(const std::string& bytes) {  // FNV-1a
    std::uint64_t hash = 0xcbf29ce484222325u;
    for (const char c : bytes) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
    return fmt::format("{:016x}", hash);
}

// Maps the name of an output to the hash of its bytes, for all command lines; of EXR files, to that of what is in them.
using Hashes = std::map<std::string, std::string>;

// All real height maps except those in `without`, sorted by name.
std::vector<std::string> real_heights(const std::vector<std::string>& without) {
    std::vector<std::string> files;
    if (!fs::exists(kReal)) return files;
    for (const auto& entry : fs::directory_iterator(kReal)) {
        const fs::path extension = entry.path().extension();
        const bool is_read = !is_emulated() || extension == ".png" || extension == ".exr";
        if (is_read && std::find(without.begin(), without.end(), entry.path().filename()) == without.end())
            files.push_back(fs::canonical(entry.path()));
    }
    std::sort(files.begin(), files.end());
    return files;
}

std::vector<std::string> arguments_of(const Line& line) {
    std::vector<std::string> arguments;
    for (auto it = line.arguments.begin(); it != line.arguments.end(); ++it) {
        std::vector<std::string> files = {*it};
        if (*it == "HEIGHTS") files = kHeights;
        if (*it == "MAPS") files = kMaps;
        if (*it == "REAL") files = real_heights({it + 1, line.arguments.end()});
        arguments.insert(arguments.end(), files.begin(), files.end());
        if (*it == "REAL") break;
    }
    return arguments;
}

Hashes run_lines(const std::string& target, int threads, std::span<const Line> lines) {
    const Scratch scratch;
    for (const std::string& height : kHeights) scratch.add_sample(height, height);
    scratch.add_sample("bricks.png", "bricks.png");
    scratch.write("sheet.obj", kSheetObj);
    for (const std::string mesh : {"crate_low.glb", "crate_high.glb"}) scratch.add_sample(mesh, mesh);
    fs::create_directory(scratch.path("maps"));
    if (lines.data() != kLines) {
        const Ran ran =
            run(scratch, "bake-normals",
                {"waves.png", "-o", "maps/waves.png", "--format", "rgb16", "--bumpiness", "6", "--no-sync"});
        EXPECT_EQ(ran.code, 0) << ran.err;
    }
    Hashes hashes;
    for (const Line& line : lines) {
        std::vector<std::string> arguments = arguments_of(line);
        const bool writes =
            std::string_view(line.command) != "check-normals" && std::string_view(line.command) != "compare-normals";
        if (writes) arguments.insert(arguments.end(), {"--out-dir", line.name, "--no-sync"});
        arguments.insert(arguments.end(), {"--threads", std::to_string(threads)});
        Setting setting;
        if (target != kEmulated)
            setting.environment = {"LD_PRELOAD=" TEX_BINARY_DIR "/target.so", "TEX_TARGET=" + target};
        const Ran ran = run(scratch, line.command, arguments, setting);
        EXPECT_TRUE(ran.code == 0 || (!writes && ran.code == 1)) << line.name << ": " << ran.code << "\n" << ran.err;
        if (!writes) hashes[fmt::format("{}/stdout", line.name)] = hash_of(without_seconds(ran.out));
        if (!writes || !scratch.has(line.name)) continue;
        for (const auto& entry : fs::directory_iterator(scratch.path(line.name))) {
            const std::string name = fmt::format("{}/{}", line.name, entry.path().filename().string());
            hashes[name] = hash_of(plain_exr(scratch.read(name)));
        }
    }
    return hashes;
}

bool is_large(const std::string& name) { return name.starts_with("large"); }

// The entries of the list whose outputs are large, or those whose outputs are not.
Hashes golden(bool large) {
    std::ifstream file(kList);
    Hashes hashes;
    for (std::string hash, name; file >> hash >> name;) {
        if (is_large(name) == large) hashes[name] = hash;
    }
    return hashes;
}

void expect_listed(const Hashes& hashes, const Hashes& wanted, int threads) {
    for (const auto& [name, hash] : hashes) {
        const auto golden_hash = wanted.find(name);
        EXPECT_TRUE(golden_hash != wanted.end() && golden_hash->second == hash)
            << name << " with " << threads
            << " threads has other bytes than tests/golden/commands.txt says, or than with one";
    }
}

std::vector<std::string> targets() {
    if (is_emulated()) return {kEmulated};
    std::vector<std::string> names;
    for (std::int64_t left = hwy::SupportedTargets(); left != 0; left &= left - 1)
        names.emplace_back(hwy::TargetName(left & -left));
    return names;
}

class Matrix : public testing::TestWithParam<std::string> {};

TEST_P(Matrix, EveryCommandMakesTheGoldenBytes) {
    if (std::getenv("TEX_GOLDEN_WRITE") != nullptr) {
        static bool written = false;
        if (written) return;
        Hashes all = run_lines(GetParam(), 1, kLines);
        all.merge(run_lines(GetParam(), 1, kLargeLines));
        std::ofstream file(kList);
        for (const auto& [name, hash] : all) file << hash << " " << name << "\n";
        written = true;
        return;
    }
    const Hashes listed = golden(false);
    static const Hashes first = run_lines(targets().front(), 1, kLines);
    const Hashes& wanted = listed.empty() ? first : listed;
    for (const int threads : kThreads) {
        if (is_emulated() && threads < 8) continue;  // QEMU takes minutes
        const Hashes hashes = run_lines(GetParam(), threads, kLines);
        EXPECT_EQ(hashes.size(), wanted.size());
        expect_listed(hashes, wanted, threads);
    }
}

#if !defined(__SANITIZE_ADDRESS__)  // with it they take minutes
TEST_P(Matrix, LargeAndRealHeightMapsMakeTheGoldenBytes) {
    if (std::getenv("TEX_GOLDEN_WRITE") != nullptr) return;
    const auto all = targets();
    const auto index = static_cast<std::size_t>(std::find(all.begin(), all.end(), GetParam()) - all.begin());
    const int threads = kThreads[index % std::size(kThreads)];
    const Hashes hashes = run_lines(GetParam(), threads, kLargeLines);
    const Hashes wanted = golden(true);
    if (!wanted.empty()) expect_listed(hashes, wanted, threads);
    EXPECT_TRUE(hashes.size() == wanted.size() || is_emulated() || !fs::exists(kReal)) << hashes.size();
    int both_ways = 0;
    for (const auto& [name, hash] : hashes) {
        if (!name.starts_with("large/")) continue;
        EXPECT_EQ(hashes.at("large-whole" + name.substr(5)), hash) << name << ": a few rows and all of them";
        ++both_ways;
    }
    EXPECT_GE(both_ways, fs::exists(kReal) && !is_emulated() ? 18 : 1);
}
#endif

INSTANTIATE_TEST_SUITE_P(Targets, Matrix, testing::ValuesIn(targets()));

}  // namespace
}  // namespace tex::cli
