// SPDX-License-Identifier: Apache-2.0
// build_bench: measures build-normals on many textures.
//
//     ninja -C build/release build_bench build-normals && build/release/build_bench [COUNT [FOLDER]]
//
// Makes COUNT (10000) height maps of 64x64 in FOLDER (default /tmp/build_bench, which is removed first) and prints a
// table in Markdown: the first build, then medians of 7 runs in which nothing is to do, the first run after all files
// got new times, and a clone with a warm cache. Then 533 height maps of 128x128, with and without one detail map of
// 1024x1024 that all of them blend; the ratio is the median of those of 7 pairs.

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "bench/height_maps.h"
#include "bench/process.h"

namespace {

namespace fs = std::filesystem;
using bench::Measured;

std::string folder = "/tmp/build_bench";

void make_tree(int count) {
    fs::remove_all(folder);
    std::ifstream sample(TEX_SOURCE_DIR "/samples/ramp.png", std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(sample), {}};
    for (int k = 0; k < count; ++k) {
        const fs::path path = folder + "/art/" + std::to_string(k / 100) + "/t" + std::to_string(k) + "_h.png";
        fs::create_directories(path.parent_path());
        // Decoders ignore what follows the picture; so every file has its own contents.
        std::ofstream(path, std::ios::binary) << bytes << k;
    }
    std::ofstream(folder + "/normals.toml") << "version = 1\n[defaults]\nout-dir = 'out'\n[[rule]]\nmatch = "
                                               "'art/**/*_h.png'\nname = '{dir}/{stem:-_h}_n.dds'\nsteps = [ { bake = "
                                               "{ bumpiness = 4 } } ]\n";
}

std::string beside(const char* program) {
    return (fs::read_symlink("/proc/self/exe").parent_path() / program).string();
}

Measured build() {
    return bench::run(
        {beside("build-normals"), folder + "/normals.toml", "--no-sync", "--quiet", "--cache", folder + "/cache"});
}

void print(const char* what, const Measured& measured) {
    std::printf("| %s | %.3f s | %.3f s | %.0f MB |\n", what, measured.wall, measured.user + measured.system,
                measured.memory);
}

void compare_details() {
    fs::remove_all(folder);
    fs::create_directories(folder + "/art");
    for (int k = 0; k < 533; ++k) bench::write_png(folder + "/art/" + std::to_string(k) + ".png", 128, 128, 8, 128 * k);
    bench::write_png(folder + "/heights.png", 1024, 1024, 8);
    bench::run({beside("bake-normals"), folder + "/heights.png", "-o", folder + "/detail.png", "--bumpiness", "4"});
    const auto manifest = [](const char* name, const std::string& step) {
        std::ofstream(folder + "/" + name) << "version = 1\n[[rule]]\nmatch = 'art/*.png'\nout-dir = 'out'\n"
                                              "steps = [ { bake = { bumpiness = 4 } }"
                                           << step << ", { mip = {} } ]\n";
    };
    manifest("plain.toml", "");
    manifest("detail.toml", ", { blend = { detail = 'detail.png', tiling = 2 } }");
    const auto run = [](const std::string& name) {
        fs::remove_all(folder + "/out");
        fs::remove(folder + "/." + name + ".state");
        return bench::run({beside("build-normals"), folder + "/" + name, "--no-sync", "--quiet"});
    };
    std::vector<Measured> plain, detail;
    std::vector<double> ratios;
    for (int k = 0; k < 7; ++k) {
        plain.push_back(run("plain.toml"));
        detail.push_back(run("detail.toml"));
        ratios.push_back((detail.back().user + detail.back().system) / (plain.back().user + plain.back().system));
    }
    print("533 maps of 128x128", bench::median_of(plain));
    print("the same with a detail of 1024x1024", bench::median_of(detail));
    std::printf("ratio of processor time: %.2f\n", bench::median(ratios));
}

}  // namespace

int main(int argc, char** argv) {
    const int count = argc > 1 ? std::atoi(argv[1]) : 10000;
    if (argc > 2) folder = argv[2];
    make_tree(count);
    std::printf("| %d textures | wall | CPU | memory |\n|---|---|---|---|\n", count);
    print("the first build", build());
    std::vector<double> walls, busy;
    Measured last;
    for (int k = 0; k < 7; ++k) {
        last = build();
        walls.push_back(last.wall);
        busy.push_back(last.user + last.system);
    }
    print("nothing to do", {bench::median(walls), bench::median(busy), 0.0, last.memory});
    for (const auto& entry : fs::recursive_directory_iterator(folder + "/art"))
        fs::last_write_time(entry.path(), fs::file_time_type::clock::now());
    print("new times, same contents", build());
    fs::remove_all(folder + "/out");
    fs::remove(folder + "/.normals.toml.state");
    print("a clone with a warm cache", build());
    compare_details();
}
