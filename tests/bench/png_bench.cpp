// SPDX-License-Identifier: Apache-2.0
// png_bench: decodes PNG files in memory, as the commands do and through libpng alone.
//
//     ninja -C build/release png_bench && build/release/png_bench [FOLDER]
//
// Prints a table in Markdown: medians of 7 pairs, in processor time, which other programs on the machine change little.
// The files are those of pipeline_bench, in FOLDER (default /tmp/pipeline_bench), and are made if they are missing.

#include <time.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "bench/height_maps.h"
#include "bench/process.h"
#include "formats/png/png.h"

namespace {

using Files = std::vector<std::vector<std::byte>>;
using Open = tex::Result<std::unique_ptr<tex::RowSource>>(tex::InputFile&, const tex::ReadOptions&);

double processor_time() {
    timespec time{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_nsec) * 1e-9;
}

// Decodes some rows at a time, and discards them.
double decode(const Files& files, Open& open) {
    constexpr int kRows = 8;
    double seconds = 0.0;
    for (const std::vector<std::byte>& bytes : files) {
        tex::Result<tex::InputFile> file = tex::InputFile::from_memory("a.png", bytes);
        const double begin = processor_time();
        const auto source = open(*file, {});
        std::vector<std::byte> rows((*source)->row_bytes() * kRows);
        const int height = (*source)->extent().height;
        bool done = true;
        for (int j = 0; j < height; j += kRows)
            done = done && (*source)->decode(j, std::min(kRows, height - j), rows.data());
        if (!done || !(*source)->finish()) std::exit(1);
        seconds += processor_time() - begin;
    }
    return seconds;
}

void row(const std::string& what, const Files& files) {
    std::vector<double> ours, theirs, ratios;
    decode(files, tex::open_png);
    for (int k = 0; k < 7; ++k) {
        theirs.push_back(decode(files, tex::open_png_with_libpng));
        ours.push_back(decode(files, tex::open_png));
        ratios.push_back(ours.back() / theirs.back());
    }
    std::printf("| %s | %.1f | %.1f | %.2f |\n", what.c_str(), bench::median(ours) * 1e3, bench::median(theirs) * 1e3,
                bench::median(ratios));
    std::fflush(stdout);
}

std::vector<std::byte> heights(const std::string& path, int size, int bits, int dx) {
    if (!std::filesystem::exists(path)) bench::write_png(path, size, size, bits, dx);
    std::ifstream file(path, std::ios::binary);
    const std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
    const auto* bytes = reinterpret_cast<const std::byte*>(text.data());
    return {bytes, bytes + text.size()};
}

// Three height maps in one picture, written by libtex.
std::vector<std::byte> colors(int size) {
    tex::Texture texture;
    texture.format = tex::Format::rgb8_unorm;
    tex::Level level{{size, size}, {}};
    for (int j = 0; j < size; ++j) {
        for (int i = 0; i < size; ++i) {
            for (const int shift : {0, 500, 1500})
                level.bytes.push_back(static_cast<std::byte>(bench::height(i + shift, j) * 255.0f));
        }
    }
    texture.levels.push_back(std::move(level));
    return *tex::encode_png(texture);
}

}  // namespace

int main(int argc, char** argv) {
    const std::string folder = argc > 1 ? argv[1] : "/tmp/pipeline_bench";
    std::printf("| PNG | ms | libpng, ms | ratio |\n|---|---|---|---|\n");
    for (const int bits : {8, 16}) {
        const std::string depth = std::to_string(bits);
        std::filesystem::create_directories(folder + "/many_" + depth);
        row("4096x4096, grey, " + depth + " bits", {heights(folder + "/4096_" + depth + ".png", 4096, bits, 0)});
        Files many;
        for (int k = 0; k < 1000; ++k)
            many.push_back(heights(folder + "/many_" + depth + "/" + std::to_string(k) + ".png", 256, bits, k));
        row("1000 of 256x256, grey, " + depth + " bits", many);
    }
    row("4096x4096, RGB, 8 bits", {colors(4096)});
    return 0;
}
