// SPDX-License-Identifier: Apache-2.0
// bc7_bench BC7ENC FILE ...: BC7 by direction beside bc7e, on pictures of x, y and z whose sides are whole blocks.
// BC7ENC is the program bc7enc of bc7enc_rdo with bc7e (npm's @gpu-tex-enc/bc contains it), or - for none. Prints the
// mean angle in degrees, that over bc7e's best, and megatexels a second of processor time, of bc7e with its reading of
// PNG.

#include <cmath>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <string>
#include <vector>

#include <tex/check.h>
#include <tex/file.h>
#include <tex/pack.h>

#include "bench/process.h"
#include "scratch.h"

namespace {

struct Row {
    std::string name;
    double logarithms = 0, worst = 0, seconds = 0, texels = 0;
};

// The mean angle between a map and a texture of it; a negative number if it cannot be read.
double angle_of(const tex::NormalMap& map, const tex::Result<tex::Texture>& texture) {
    if (!texture) return -1;
    const auto normals = tex::unpack(*texture);
    if (!normals) return -1;
    const auto compared = tex::compare(map, normals->levels.front());
    return compared ? compared->error.mean : -1;
}

void add(Row& row, double angle, double best, double seconds, double texels) {
    row.logarithms += std::log(angle / best);
    row.worst = std::max(row.worst, angle / best);
    row.seconds += seconds;
    row.texels += texels;
    std::printf(" %s %.4f (%.3f, %.2f)", row.name.c_str(), angle, angle / best, texels / seconds);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 3) return 2;
    const std::string bc7enc = argv[1];
    const tex::Scratch scratch;
    const std::string made = scratch.path("bc7.dds");
    std::vector<Row> theirs = {{"-u6"}, {"-u4"}, {"-u1"}}, ours = {{"fast"}, {"normal"}, {"best"}};
    for (int k = 2; k < argc; ++k) {
        const auto image = tex::read_image(argv[k]);
        auto map = image ? tex::unpack(*image) : tex::Result<tex::NormalMap>(image.error());
        if (!map) {
            std::fprintf(stderr, "%s\n", map.error().message().c_str());
            return 1;
        }
        const double texels = 1e-6 * static_cast<double>(map->extent().texels());
        double best = 1;
        std::printf("%s:", std::filesystem::path(argv[k]).stem().c_str());
        for (Row& row : theirs) {
            if (bc7enc == "-") continue;
            const bench::Measured ran = bench::run({bc7enc, "-U", row.name, "-g", argv[k], made});
            const double angle = angle_of(*map, tex::read_texture(made));
            if (&row == theirs.data()) best = angle;
            add(row, angle, best, ran.user + ran.system, texels);
        }
        tex::MipChain chain;
        chain.levels.push_back(std::move(*map));
        for (std::size_t effort = 0; effort < ours.size(); ++effort) {
            tex::PackOptions options;
            options.encoding = tex::Encoding::bc7;
            options.effort = static_cast<tex::Effort>(effort);
            const std::clock_t begin = std::clock();
            const auto texture = tex::pack(chain, options, {1, {}});
            const double seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
            if (!texture) return 1;
            add(ours[effort], angle_of(chain.levels[0], *texture), best, seconds, texels);
        }
        std::printf("\n");
        std::fflush(stdout);
    }
    std::printf("\n| | geometric mean | worst | Mtexel/s |\n|---|---|---|---|\n");
    for (const auto& rows : {theirs, ours}) {
        for (const Row& row : rows) {
            if (row.texels == 0) continue;
            std::printf("| %s | %.3f | %.3f | %.2f |\n", row.name.c_str(), std::exp(row.logarithms / (argc - 2)),
                        row.worst, row.texels / row.seconds);
        }
    }
    return 0;
}
