// SPDX-License-Identifier: Apache-2.0
// repack_bench: measures whole processes that read normal maps, from file to file: mip-, pack- and unpack-normals.
//
//     ninja -C build/release repack_bench bake-normals mip-normals pack-normals unpack-normals &&
//     build/release/repack_bench [--runs N] [FOLDER]
//
// Prints a table in Markdown: medians of N (at least 7) pairs of runs. The runs of a pair are the command and its
// baseline, in turn; ratios are those of the pairs. The baseline of PNG is libpng, which decodes the input and discards
// the rows; compared with that, reading DDS costs nothing. Files are written to FOLDER (default /tmp/pipeline_bench,
// where pipeline_bench has the same height map) and kept there.

#include <cstring>
#include <filesystem>
#include <string>

#include "bench/height_maps.h"
#include "bench/process.h"

namespace {

using bench::Measured;
using Command = std::vector<std::string>;

int runs = 7;
std::string folder = "/tmp/pipeline_bench";

std::string own_path() { return std::filesystem::read_symlink("/proc/self/exe").string(); }
std::string beside(const std::string& name) { return std::filesystem::path(own_path()).parent_path() / name; }
std::string file(const std::string& name) { return folder + "/" + name; }

// Converts the height map to normals once.
std::string need(const std::string& name, const Command& options) {
    const std::string heights = file("4096_8.png");
    if (!std::filesystem::exists(heights)) bench::run_apart([&] { bench::write_png(heights, 4096, 4096, 8); });
    if (std::filesystem::exists(file(name))) return file(name);
    Command command = {beside("bake-normals"), heights, "-o", file(name), "--bumpiness", "12", "--no-sync"};
    command.insert(command.end(), options.begin(), options.end());
    bench::run(command);
    return file(name);
}

void row(const std::string& work, const std::string& program, const std::string& input, const std::string& output,
         const Command& options) {
    Command command = {beside(program), input, "-o", file(output), "--no-sync", "--quiet", "--threads", "2"};
    command.insert(command.end(), options.begin(), options.end());
    const bool has_baseline = input.ends_with(".png");
    std::vector<Measured> ours, theirs;
    std::vector<double> ratios;
    bench::run(command);  // fills caches, and makes the outputs that later runs replace
    for (int k = 0; k < runs; ++k) {
        if (has_baseline) theirs.push_back(bench::run({own_path(), "--decode-png", input}));
        ours.push_back(bench::run(command));
        if (has_baseline) ratios.push_back(ours.back().wall / theirs.back().wall);
    }
    const Measured us = bench::median_of(ours);
    std::printf("| %s | %.3f | %.3f | %.0f |", work.c_str(), us.wall, us.user + us.system, us.memory);
    has_baseline ? std::printf(" %.3f | %.2f |\n", bench::median_of(theirs).wall, bench::median(ratios))
                 : std::printf(" | |\n");
    std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc > 2 && std::strcmp(argv[1], "--decode-png") == 0) return bench::decode_png(argv[2]);
    for (int k = 1; k < argc; ++k) {
        if (std::strcmp(argv[k], "--runs") == 0 && k + 1 < argc) {
            runs = std::max(7, std::atoi(argv[++k]));
        } else {
            folder = argv[k];
        }
    }
    std::filesystem::create_directories(folder);
    const std::string rgb8 = need("normals_8.png", {"--format", "rgb8"});
    const std::string rgb16 = need("normals_16.png", {"--format", "rgb16"});
    const std::string dxt5nm = need("normals.dds", {});
    std::printf(
        "4096x4096 normals, --no-sync, 2 threads\n\n| work | wall, s | user and system, s | peak, MB | reading alone, "
        "s | ratio |\n"
        "|---|---|---|---|---|---|\n");
    row("mip-normals, 8-bit PNG to DXT5nm, fast", "mip-normals", rgb8, "repacked.dds", {"--effort", "fast"});
    row("mip-normals, 16-bit PNG to DXT5nm", "mip-normals", rgb16, "repacked.dds", {});
    row("pack-normals, DXT5nm in DDS with levels to BC5 in KTX2", "pack-normals", dxt5nm, "repacked.ktx2",
        {"--format", "bc5"});
    row("unpack-normals, DXT5nm in DDS to 8-bit PNG", "unpack-normals", dxt5nm, "repacked.png", {});
    row("unpack-normals, DXT5nm in DDS to half EXR", "unpack-normals", dxt5nm, "repacked.exr", {});
    return 0;
}
