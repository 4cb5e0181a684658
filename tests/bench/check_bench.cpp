// SPDX-License-Identifier: Apache-2.0
// check_bench: what a check costs beside decoding the same texture to floats, and what a comparison costs.
//
//     check_bench [SIDE]        a DXT5nm of SIDE x SIDE texels (4096) with all mip levels
//
// Wall-clock time with all threads, the least of five runs. What the rules find and miss on real maps with planted damage is the
// output of the unit test CheckData.FindsPlantedDamage.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <utility>

#include <tex/tex.h>

namespace {

using namespace tex;

double least_seconds(const std::function<bool()>& body) {
    double least = 1e9;
    for (int run = 0; run < 5; ++run) {
        const auto begin = std::chrono::steady_clock::now();
        if (!body()) std::exit(1);
        least = std::min(least, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
    }
    return least;
}

HeightField hills(Extent extent) {
    HeightField field{Plane<float>(extent), 20.0f, 20.0f, Wrap::repeat, Wrap::repeat};
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            field.height.at(i, j) = static_cast<float>(std::sin(i * 0.05 + std::cos(j * 0.03)) * std::cos(j * 0.04) +
                                                       0.2 * std::sin(i * 0.31 + j * 0.27));
        }
    }
    return field;
}

}  // namespace

int main(int argc, char** argv) {
    const int side = argc > 1 ? std::atoi(argv[1]) : 4096;
    if (side < 1 || side > 16384) return 2;
    auto normals = bake(hills({side, side}));
    if (!normals) return 1;
    auto chain = build_mip_chain(std::move(*normals));
    if (!chain) return 1;
    const auto texture = pack(*chain, {Encoding::dxt5nm, YAxis::up, Effort::fast});
    if (!texture) return 1;
    const auto decoded = [&] {
        for (int k = 0; k < static_cast<int>(texture->levels.size()); ++k) {
            if (!decode(*texture, k)) return false;
        }
        return true;
    };
    const double decoding = least_seconds(decoded);
    const double checking = least_seconds([&] { return static_cast<bool>(check("map", *texture)); });
    const double comparing = least_seconds([&] { return static_cast<bool>(compare(chain->levels[0], chain->levels[0])); });
    std::printf("%d x %d, DXT5nm, %zu levels\n", side, side, texture->levels.size());
    std::printf("decode   %7.1f ms\n", 1e3 * decoding);
    std::printf("check    %7.1f ms   %.2f times decode\n", 1e3 * checking, checking / decoding);
    std::printf("compare  %7.1f ms   base level, floats\n", 1e3 * comparing);
    return 0;
}
