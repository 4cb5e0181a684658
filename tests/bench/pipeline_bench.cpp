// SPDX-License-Identifier: Apache-2.0
// pipeline_bench: measures whole processes, from file to file, against the minimum cost of reading the file.
//
//     ninja -C build/release pipeline_bench bake-normals blend-normals pack-normals tex-reader &&
//     build/release/pipeline_bench [--runs N] [--large] [--many] [--png] [FOLDER]
//
// Prints tables in Markdown. Each row is the median of N (at least 7) pairs of runs. The runs of a pair are the command
// and its baseline, in turn; ratios are those of the pairs. The commands are those in the folder of this program. Their
// outputs are new files, except where a row says that they replace one: ext4 then begins to write the new file to the
// disk before it has its name, even with --no-sync.
// Height maps are written to FOLDER (default /tmp/pipeline_bench) and kept there. --large adds the memory of
// 16384x16384 and 65536x4096 texels; --many prints only the rows of a thousand small files, --png only those of PNG
// inputs. --before DIR prints only rows of PNG and EXR outputs; their baseline is another build, whose bake-normals and
// libtex.so are in DIR.

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <thread>

#include "bench/height_maps.h"
#include "bench/process.h"

namespace {

using bench::Measured;
using Command = std::vector<std::string>;
enum class Output { is_new, replaces };

std::string own_path() { return std::filesystem::read_symlink("/proc/self/exe").string(); }
std::string beside(const std::string& name) { return std::filesystem::path(own_path()).parent_path() / name; }

struct Bench {
    int runs = 7;
    bool large = false;
    bool many = false;
    bool png = false;
    std::string before;       // the folder of another build
    bool only_makes = false;  // only makes the files that rows need
    std::string folder = "/tmp/pipeline_bench";

    [[nodiscard]] std::string file(const std::string& name) const { return folder + "/" + name; }
    // Makes a file unless it exists.
    std::string need(const std::string& name, const std::function<void(const std::string&)>& make) const {
        const std::string path = file(name);
        if (!std::filesystem::exists(path)) {
            make(path + ".part");
            std::filesystem::rename(path + ".part", path);
        }
        return path;
    }

    // Removes the file after -o, if the command has one.
    static void remove_output(const Command& command) {
        const auto option = std::find(command.begin(), command.end(), "-o");
        if (option != command.end()) std::filesystem::remove(*(option + 1));
    }

    // One row: a command and its baseline. The times of the baseline are multiplied by `scale`.
    void row(const std::string& work, const Command& command, const Command& baseline, double target,
             double scale = 1.0, Output output = Output::is_new) const {
        if (only_makes) return;
        std::vector<Measured> ours, theirs;
        std::vector<double> ratios;
        bench::run(command);  // fills caches, and makes the files that later runs replace
        for (int k = 0; k < runs; ++k) {
            theirs.push_back(bench::run(baseline));
            if (output == Output::is_new) remove_output(command);
            ours.push_back(bench::run(command));
            ratios.push_back(ours.back().wall / (theirs.back().wall * scale));
        }
        const Measured us = bench::median_of(ours);
        const Measured them = bench::median_of(theirs);
        std::printf("| %s | %.3f | %.3f | %.3f | %.0f | %.3f | %.3f | %.2f | %s |\n", work.c_str(), us.wall, us.user,
                    us.system, us.memory, them.wall * scale, (them.user + them.system) * scale, bench::median(ratios),
                    target > 0.0 ? (std::to_string(target).substr(0, 4)).c_str() : "");
        std::fflush(stdout);
    }

    // One row without a baseline.
    void plain_row(const std::string& work, const Command& command, const std::string& target, int times) const {
        if (only_makes) return;
        std::vector<Measured> ours;
        bench::run(command);
        for (int k = 0; k < times; ++k) ours.push_back(bench::run(command));
        const Measured us = bench::median_of(ours);
        std::printf("| %s | %.1f | %.1f | %.1f | %.1f | %s |\n", work.c_str(), us.wall * 1e3, us.user * 1e3,
                    us.system * 1e3, us.memory, target.c_str());
        std::fflush(stdout);
    }
};

bool is_installed(const std::string& program) {
    return std::system(("command -v " + program + " >/dev/null 2>&1").c_str()) == 0;
}

Command bake(const std::string& input, const std::string& output, const Command& more) {
    Command command = {beside("bake-normals"), input, "-o", output, "--bumpiness", "12", "--threads", "2"};
    command.insert(command.end(), more.begin(), more.end());
    return command;
}

// Keeps `threads` cores busy with arithmetic only. This shows the most that two threads can gain on this machine.
int spin(int threads) {
    const auto work = [threads] {
        volatile std::uint64_t sink = 0;
        std::uint64_t x = 1;
        for (std::int64_t k = 0; k < 1'500'000'000 / threads; ++k) x = x * 6364136223846793005u + 1442695040888963407u;
        sink = x;
        return sink;
    };
    std::vector<std::thread> others;
    for (int k = 1; k < threads; ++k) others.emplace_back(work);
    work();
    for (std::thread& other : others) other.join();
    return 0;
}

// Two RGB maps of one size, side by side.
void print_blended(const Bench& b) {
    Command command = {beside("blend-normals")}, drop = {own_path(), "--decode-png"};
    for (const std::string kernel : {"sobel", "central"}) {
        const std::string map = b.need("normals_" + kernel + ".png", [&](const std::string& p) {
            bench::run({beside("bake-normals"), b.file("4096_8.png"), "-o", b.file("made.png"), "--kernel", kernel,
                        "--format", "rgb8", "--bumpiness", "12", "--no-sync"});
            std::filesystem::rename(b.file("made.png"), p);
        });
        command.push_back(map);
        drop.push_back(map);
    }
    const Command more = {"-o", b.file("out.dds"), "--effort", "fast", "--threads", "2", "--no-sync"};
    command.insert(command.end(), more.begin(), more.end());
    b.row("two 8-bit RGB PNGs blended, fast, --no-sync; baseline: decoding both", command, drop, 0.9);
}

void print_against_decoders(const Bench& b) {
    const std::string out = b.file("out.dds");
    const std::string png8 = b.need("4096_8.png", [](const std::string& p) { bench::write_png(p, 4096, 4096, 8); });
    const std::string png16 = b.need("4096_16.png", [](const std::string& p) { bench::write_png(p, 4096, 4096, 16); });
    const Command drop8 = {own_path(), "--decode-png", png8};
    const Command drop16 = {own_path(), "--decode-png", png16};
    std::printf(
        "4096x4096 heights to DXT5nm DDS with all levels, 2 threads; the baseline decodes the file and throws the rows "
        "away\n\n"
        "| work | wall, s | user, s | system, s | peak, MB | baseline, s | its user and system, s | ratio | target "
        "|\n|---|---|---|---|---|---|---|---|---|\n");
    b.row("8-bit PNG, fast, --no-sync", bake(png8, out, {"--effort", "fast", "--no-sync"}), drop8, 0.7);
    b.row("8-bit PNG, fast, --no-sync, replacing a file", bake(png8, out, {"--effort", "fast", "--no-sync"}), drop8,
          0.0, 1.0, Output::replaces);
    b.row("8-bit PNG, fast", bake(png8, out, {"--effort", "fast"}), drop8, 0.0);
    b.row("16-bit PNG, fast, --no-sync", bake(png16, out, {"--effort", "fast", "--no-sync"}), drop16, 0.5);
    b.row("16-bit PNG, fast", bake(png16, out, {"--effort", "fast"}), drop16, 0.0);
    b.row("8-bit PNG, normal, --no-sync", bake(png8, out, {"--no-sync"}), drop8, 1.25);
    b.row("8-bit PNG, normal", bake(png8, out, {}), drop8, 0.0);
    b.row("16-bit PNG, normal, --no-sync", bake(png16, out, {"--no-sync"}), drop16, 0.6);
    b.row("16-bit PNG, normal", bake(png16, out, {}), drop16, 0.0);
    print_blended(b);
    if (b.png) return;
    const std::string exr = b.need("4096.exr", [](const std::string& p) { bench::write_exr(p, 4096, 4096); });
    const Command read_exr = {own_path(), "--decode-exr", exr};
    b.row("half EXR (zip), fast, --no-sync", bake(exr, out, {"--effort", "fast", "--no-sync"}), read_exr, 0.75);
    b.row("half EXR (zip), fast, --no-sync, replacing a file", bake(exr, out, {"--effort", "fast", "--no-sync"}),
          read_exr, 0.0, 1.0, Output::replaces);
    b.row("half EXR (zip), fast", bake(exr, out, {"--effort", "fast"}), read_exr, 0.0);
    if (is_installed("convert")) {
        b.row("8-bit PNG, ImageMagick (BC3 with levels, no normals)",
              {"convert", png8, "-define", "dds:compression=dxt5", "-define", "dds:fast-mipmaps=true", "-define",
               "dds:cluster-fit=false", out},
              drop8, 0.0);
    }
    if (is_installed("maketx")) {
        b.row("8-bit PNG, maketx --bumpslopes (EXR, no blocks)",
              {"maketx", "--bumpslopes", "--threads", "2", "-d", "half", png8, "-o", b.file("out.exr")}, drop8, 0.0);
    }
}

// PNG and EXR outputs against another build.
void print_against_before(const Bench& b) {
    const auto compare = [&](const std::string& work, Command ours) {
        Command theirs = ours;
        theirs[0] = b.before + "/bake-normals";
        theirs.insert(theirs.begin(), {"env", "LD_LIBRARY_PATH=" + b.before});
        b.row(work, ours, theirs, 0.0);
    };
    std::printf(
        "PNG and EXR outputs; the baseline is the build in %s\n\n"
        "| work | wall, s | user, s | system, s | peak, MB | baseline, s | its user and system, s | ratio | target "
        "|\n|---|---|---|---|---|---|---|---|---|\n",
        b.before.c_str());
    const std::string out = b.file("out.png");
    for (const int bits : {8, 16}) {
        const std::string name = "4096_" + std::to_string(bits) + ".png";
        const std::string input = b.need(name, [&](const std::string& p) { bench::write_png(p, 4096, 4096, bits); });
        for (const std::string threads : {"1", "2"}) {
            Command command = bake(input, out, {"--format", bits == 8 ? "rgb8" : "rgb16", "--no-sync"});
            *(std::find(command.begin(), command.end(), "--threads") + 1) = threads;
            compare(std::to_string(bits) + "-bit PNG to rgb" + std::to_string(bits) + " PNG, threads: " + threads,
                    command);
        }
    }
    const std::string png = b.file("4096_8.png"), exr = b.file("out.exr");
    for (const std::string threads : {"1", "2"}) {
        for (const std::string levels : {"none", "all"}) {
            Command command = bake(png, exr, {"--format", "half", "--mips", levels, "--no-sync"});
            *(std::find(command.begin(), command.end(), "--threads") + 1) = threads;
            compare("8-bit PNG to half EXR, levels: " + levels + ", threads: " + threads, command);
        }
    }
    const std::string folder = b.file("many_png");
    std::filesystem::create_directories(b.file("many_8"));
    std::filesystem::create_directories(folder);
    Command many = {beside("bake-normals"), "--out-dir", folder,      "--name", "{stem}.png", "--format", "rgb8",
                    "--bumpiness",          "12",        "--threads", "2",      "--no-sync",  "--quiet"};
    for (int k = 0; k < 1000; ++k) {
        many.push_back(b.need("many_8/" + std::to_string(k) + ".png",
                              [&](const std::string& p) { bench::write_png(p, 256, 256, 8, k); }));
    }
    compare("1000 8-bit PNGs of 256x256 to rgb8 PNG", many);
}

void print_many(const Bench& b) {
    for (const int bits : {8, 16}) {
        const std::string folder = "many_" + std::to_string(bits);
        Command files;
        std::filesystem::create_directories(b.file(folder));
        for (int k = 0; k < 1000; ++k) {
            files.push_back(b.need(folder + "/" + std::to_string(k) + ".png",
                                   [&](const std::string& p) { bench::write_png(p, 256, 256, bits, k); }));
        }
        Command drop = {own_path(), "--decode-png"};
        drop.insert(drop.end(), files.begin(), files.end());
        // On a disk's file system, creating a thousand files takes as long as everything else; the baseline creates
        // none.
        const std::string memory = "/dev/shm/pipeline_bench";
        for (const std::string& out : {memory, b.file("many_out")}) {
            std::filesystem::create_directories(out);
            Command command = {beside("bake-normals"), "--bumpiness", "12", "--threads", "2", "--effort", "fast"};
            command.insert(command.end(), {"--out-dir", out, "--no-sync"});
            command.insert(command.end(), files.begin(), files.end());
            b.row("1000 PNGs of 256x256, " + std::to_string(bits) + " bits, fast, --no-sync, into " + out +
                      "; baseline: half of decoding them",
                  command, drop, out == memory ? 1.5 : 0.0, 0.5);
            std::filesystem::remove_all(out);
        }
    }
}

// A thousand normal maps of the same texels in other file types, against PNG. The reader process decodes and encodes
// TIFF and JPEG; the processor time of its processes is not that of the command.
void print_many_kinds(const Bench& b) {
    Command heights;
    for (int k = 0; k < 1000; ++k) heights.push_back(b.file("many_8/" + std::to_string(k) + ".png"));
    const auto add_all = [](Command command, const Command& files) {
        command.insert(command.end(), {"--threads", "2", "--no-sync", "--quiet"});
        command.insert(command.end(), files.begin(), files.end());
        return command;
    };
    const auto bake_as = [&](const std::string& kind, const std::string& folder) {
        return add_all({beside("bake-normals"), "--out-dir", folder, "--name", "{stem}." + kind, "--format", "rgb8",
                        "--bumpiness", "12"},
                       heights);
    };
    const auto pack = [&](const std::string& kind) {
        const std::string folder = b.file("many_" + kind);
        if (!std::filesystem::exists(folder + "/999." + kind)) {
            std::filesystem::create_directories(folder);
            bench::run(bake_as(kind, folder));
        }
        Command files;
        for (int k = 0; k < 1000; ++k) files.push_back(folder + "/" + std::to_string(k) + "." + kind);
        return add_all({beside("pack-normals"), "--out-dir", "/dev/shm/pipeline_bench", "--name", "{stem}.dds",
                        "--effort", "fast"},
                       files);
    };
    const std::string memory = "/dev/shm/pipeline_bench";
    std::filesystem::create_directories(memory);
    for (const auto& [kind, most] :
         std::map<std::string, double>{{"tif", 4.0}, {"tga", 1.3}, {"jpg", 4.0}, {"bmp", 1.3}}) {
        b.row("1000 " + kind + " of 256x256, fast, --no-sync, into " + memory + "; baseline: the same as PNG",
              pack(kind), pack("png"), most);
    }
    for (const std::string kind : {"tif", "tga", "jpg"}) {
        b.row("1000 PNGs of 256x256 into " + kind + "; baseline: into PNG", bake_as(kind, memory),
              bake_as("png", memory), 4.0);
    }
    std::filesystem::remove_all(memory);
}

// The input needs no inflating, so encoding takes most of the time. The outputs do not exist beforehand: freeing the
// pages of a replaced output runs on one thread and takes as long as encoding a tenth of it.
void print_scaling_of(const Bench& b, int size) {
    const std::string raw = b.need(std::to_string(size) + "_raw.exr",
                                   [&](const std::string& p) { bench::write_exr(p, size, size, Imf::NO_COMPRESSION); });
    if (b.only_makes) return;
    const auto time = [&](const Command& command) {
        std::filesystem::remove(b.file("scaled.dds"));
        return bench::run(command).wall;
    };
    Command two = bake(raw, b.file("scaled.dds"), {"--no-sync"});
    Command one = two;
    *(std::find(one.begin(), one.end(), "--threads") + 1) = "1";
    time(two);
    std::vector<double> ones, twos, ours, ideal;
    for (int k = 0; k < b.runs; ++k) {
        twos.push_back(time(two));
        ones.push_back(time(one));
        ours.push_back(ones.back() / twos.back());
        ideal.push_back(time({own_path(), "--spin", "1"}) / time({own_path(), "--spin", "2"}));
    }
    std::filesystem::remove(b.file("scaled.dds"));
    std::printf("| %dx%d | %.3f | %.3f | %.2f | %.2f | %.2f | 0.95 |\n", size, size, bench::median(ones),
                bench::median(twos), bench::median(ours), bench::median(ideal),
                bench::median(ours) / bench::median(ideal));
}

void print_scaling(const Bench& b) {
    if (!b.only_makes) {
        std::printf(
            "\n| uncompressed half EXR, normal | 1 thread, s | 2 threads, s | ratio | of a loop of arithmetic | of "
            "that | target |\n|---|---|---|---|---|---|---|\n");
    }
    for (const int size : {4096, 16384}) print_scaling_of(b, size);
}

void print_start(const Bench& b) {
    const std::string small = b.need("64.png", [](const std::string& p) { bench::write_png(p, 64, 64, 8); });
    std::printf(
        "\n| start to finish | wall, ms | user, ms | system, ms | peak, MB | target |\n|---|---|---|---|---|---|\n");
    b.plain_row("64x64 PNG to DDS", {beside("bake-normals"), small, "-o", b.file("out.dds"), "--no-sync"},
                "14 ms, 24 MB", 31);
    b.plain_row("--version", {beside("bake-normals"), "--version"}, "8 ms", 31);
    b.plain_row("4096x4096 8-bit PNG, fast",
                bake(b.file("4096_8.png"), b.file("out.dds"), {"--effort", "fast", "--no-sync"}), "64 MB", 3);
    b.plain_row("4096x4096 half EXR, fast",
                bake(b.file("4096.exr"), b.file("out.dds"), {"--effort", "fast", "--no-sync"}), "64 MB", 3);
    if (!b.large) return;
    for (const auto& [width, height, target] :
         {std::tuple(16384, 16384, "160 MB"), std::tuple(65536, 4096, "400 MB")}) {
        const std::string name = std::to_string(width) + "x" + std::to_string(height);
        const std::string path =
            b.need(name + ".png", [w = width, h = height](const std::string& p) { bench::write_png(p, w, h, 8); });
        b.plain_row(name + " 8-bit PNG, fast", bake(path, b.file("out.dds"), {"--effort", "fast", "--no-sync"}), target,
                    1);
    }
}

}  // namespace

int main(int argc, char** argv) {
    const std::string_view verb = argc > 1 ? argv[1] : "";
    if (verb == "--decode-png") {
        int failed = 0;
        for (int k = 2; k < argc; ++k) failed |= bench::decode_png(argv[k]);
        return failed;
    }
    if (verb == "--decode-exr") return bench::decode_exr(argv[2], 2);
    if (verb == "--spin") return spin(std::atoi(argv[2]));
    Bench b;
    for (int k = 1; k < argc; ++k) {
        if (std::strcmp(argv[k], "--runs") == 0 && k + 1 < argc) {
            b.runs = std::max(7, std::atoi(argv[++k]));
        } else if (std::strcmp(argv[k], "--large") == 0) {
            b.large = true;
        } else if (std::strcmp(argv[k], "--before") == 0 && k + 1 < argc) {
            b.before = argv[++k];
        } else if (std::strcmp(argv[k], "--many") == 0) {
            b.many = true;
        } else if (std::strcmp(argv[k], "--png") == 0) {
            b.png = true;
        } else {
            b.folder = argv[k];
        }
    }
    std::filesystem::create_directories(b.folder);
    const auto print_all = [](const Bench& bench) {
        if (!bench.before.empty()) return print_against_before(bench);
        if (!bench.many) print_against_decoders(bench);
        print_many(bench);
        if (bench.png) return;
        print_many_kinds(bench);
        if (bench.many) return;
        print_scaling(bench);
        print_start(bench);
    };
    const bool made = bench::run_apart([&] {
        b.only_makes = true;
        if (std::freopen("/dev/null", "w", stdout) == nullptr) _exit(1);
        print_all(b);
    });
    if (!made) return 1;
    print_all(b);
}
