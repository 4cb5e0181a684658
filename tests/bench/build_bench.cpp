// SPDX-License-Identifier: Apache-2.0
// build_bench: measures build-normals on many textures.
//
//     ninja -C build/release build_bench build-normals && build/release/build_bench [COUNT [FOLDER]]
//
// Makes COUNT (10000) height maps of 64x64 in FOLDER (default /tmp/build_bench, which is removed first) and prints a
// table in Markdown: the first build, then medians of 7 runs in which nothing is to do, the first run after all files
// got new times, and a clone with a warm cache.

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

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

Measured build() {
    const fs::path own = fs::read_symlink("/proc/self/exe");
    return bench::run({(own.parent_path() / "build-normals").string(), folder + "/normals.toml", "--no-sync", "--quiet",
                       "--cache", folder + "/cache"});
}

void print(const char* what, const Measured& measured) {
    std::printf("| %s | %.3f s | %.3f s | %.0f MB |\n", what, measured.wall, measured.user + measured.system,
                measured.memory);
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
}
