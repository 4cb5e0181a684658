// SPDX-License-Identifier: Apache-2.0
// check_bench: the cost of a check compared with decoding the same texture to floats, and what the rules find and miss.
//
//     check_bench [SIDE]        a DXT5nm of SIDE x SIDE texels (4096) with all mip levels
//
// Runs both in turn, with all threads, and prints medians of seven rounds: of the wall-clock time and of the ratio
// within a round. Prints the table of planted damages if ../shared/data exists.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <tex/tex.h>

#include "reference/detection.h"

namespace {

using namespace tex;

constexpr int kRounds = 7;

double seconds(const std::function<bool()>& body) {
    const auto begin = std::chrono::steady_clock::now();
    if (!body()) std::exit(1);
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

double median(std::vector<double> values) {
    std::nth_element(values.begin(), values.begin() + kRounds / 2, values.end());
    return values[kRounds / 2];
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
    std::vector<double> decoding, checking, ratios;
    for (int round = 0; round < kRounds; ++round) {
        decoding.push_back(seconds(decoded));
        checking.push_back(seconds([&] { return static_cast<bool>(check("map", *texture)); }));
        ratios.push_back(checking.back() / decoding.back());
    }
    std::printf("%d x %d, DXT5nm, %zu levels\n", side, side, texture->levels.size());
    std::printf("decode   %7.1f ms\n", 1e3 * median(decoding));
    std::printf("check    %7.1f ms   %.2f times decode (%.2f to %.2f)\n", 1e3 * median(checking), median(ratios),
                *std::min_element(ratios.begin(), ratios.end()), *std::max_element(ratios.begin(), ratios.end()));
    const std::string data = TEX_SOURCE_DIR "/../shared/data/";
    if (!std::filesystem::exists(data)) return 0;
    const auto detection = reference::detect_planted(data);
    if (!detection) return 1;
    std::printf("\n%s", detection->text().c_str());
    return 0;
}
