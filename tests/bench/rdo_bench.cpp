// SPDX-License-Identifier: Apache-2.0
// rdo_bench: how much smaller textures are after zstd -19 with rate-distortion optimisation, and at what angles.
//
//     rdo_bench [--one-mean] [ENCODING [WINDOW [MAX]]] [MAP ... | DIRECTORY ...]
//
// The maps are those of encode_bench, without smaller levels. For each growth of the mean angle, in percent of the mean
// angle of the plain encoding (--effort normal), it prints for each map and for all maps together: the bytes after
// zstd, the mean, 99.9th percentile and largest angle in degrees, and the processor time. "pooled" adds up the bytes,
// and averages the angles. With --one-mean, all maps have the same --rdo-mean, as in one run of the command: the growth
// is that of the average over all maps.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include <zstd.h>

#include <tex/tex.h>

#include "bench/encode_maps.h"

namespace {

using namespace bench;

constexpr std::array<int, 3> kGrowths = {0, 10, 30};

struct Point {
    double bytes = 0, mean = 0, most_999 = 0, largest = 0, seconds = 0;
};

std::size_t compressed(const std::vector<std::byte>& bytes) {
    std::vector<std::byte> out(ZSTD_compressBound(bytes.size()));
    return ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), 19);
}

// The angles between the map and the decoded texture, in double, with z rebuilt on both sides unless it is stored.
Point measure(const tex::NormalMap& map, const tex::Texture& texture, tex::Encoding encoding) {
    const tex::Result<tex::Image> image = tex::decode(texture, 0, {1, {}});
    if (!image) std::abort();
    const bool is_alpha = texture.format == tex::Format::bc3_unorm;
    const bool is_astc = texture.swizzle == tex::kSwizzleXxxy;
    const bool is_signed = texture.format == tex::Format::bc5_snorm || texture.format == tex::Format::eac_rg11_snorm;
    const bool has_z = tex::encoding_info(encoding).swizzle[2] == tex::Component::z;
    const tex::Plane<float>& xs = image->planes[is_alpha ? 3 : 0];
    const tex::Plane<float>& ys = image->planes[is_astc ? 3 : 1];
    std::vector<double> angles;
    Point point;
    for (int j = 0; j < map.extent().height; ++j) {
        for (int i = 0; i < map.extent().width; ++i) {
            const auto n = [&](float v) { return is_signed ? double{v} : 2.0 * double{v} - 1.0; };
            const double p[2] = {map.x.at(i, j), map.y.at(i, j)};
            double e[2] = {n(xs.at(i, j)), n(ys.at(i, j))};
            const double pz = std::sqrt(1.0 - std::min(1.0, p[0] * p[0] + p[1] * p[1]));
            double ez = std::sqrt(1.0 - std::min(1.0, e[0] * e[0] + e[1] * e[1]));
            if (has_z) {
                ez = n(image->planes[2].at(i, j));
                const double length = std::sqrt(e[0] * e[0] + e[1] * e[1] + ez * ez);
                e[0] /= length;
                e[1] /= length;
                ez /= length;
            }
            const double chord = std::hypot(p[0] - e[0], p[1] - e[1], pz - ez);
            angles.push_back(114.59155902616465 * std::asin(std::min(1.0, 0.5 * chord)));
            point.mean += angles.back();
        }
    }
    point.mean /= static_cast<double>(angles.size());
    const auto at = static_cast<std::ptrdiff_t>(0.999 * static_cast<double>(angles.size() - 1));
    std::nth_element(angles.begin(), angles.begin() + at, angles.end());
    point.most_999 = angles[static_cast<std::size_t>(at)];
    point.largest = *std::max_element(angles.begin(), angles.end());
    point.bytes = static_cast<double>(compressed(texture.levels[0].bytes));
    return point;
}

// `mean` is the growth that is allowed, in degrees.
Point pack_map(const Map& map, tex::PackOptions options, double mean) {
    tex::NormalMap whole({map.width, map.height});
    for (int j = 0; j < map.height; ++j) {
        for (int i = 0; i < map.width; ++i) {
            whole.x.at(i, j) = map.normals.x.at(i, j);
            whole.y.at(i, j) = map.normals.y.at(i, j);
            const double x = whole.x.at(i, j), y = whole.y.at(i, j);
            whole.z.at(i, j) = static_cast<float>(std::sqrt(std::max(0.0, 1.0 - x * x - y * y)));
        }
    }
    options.rdo.mean = static_cast<float>(mean);
    tex::MipChain chain;
    chain.levels.push_back(std::move(whole));
    const double start = processor_seconds();
    const tex::Result<tex::PackedTexture> texture = tex::pack(chain, options, {1, {}});
    const double seconds = processor_seconds() - start;
    if (!texture) std::abort();
    Point point = measure(chain.levels[0], *texture, options.encoding);
    point.seconds = seconds;
    return point;
}

void print(const std::string& name, int growth, const Point& point, const Point& plain) {
    std::printf("%-24s %4d %% %10.0f %7.2f %% %8.3f %8.2f %8.2f %8.1f\n", name.c_str(), growth, point.bytes,
                100.0 * (point.bytes / plain.bytes - 1.0), point.mean, point.most_999, point.largest, point.seconds);
    std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
    tex::PackOptions options;
    options.encoding = tex::Encoding::bc5;
    std::vector<std::string> words(argv + 1, argv + argc);
    const bool one_mean = std::erase(words, "--one-mean") != 0;
    if (!words.empty()) options.encoding = tex::find_by_name(tex::kEncodingNames, words[0]).value_or(options.encoding);
    if (words.size() > 1) options.rdo.window = std::atoi(words[1].c_str());
    if (words.size() > 2) options.rdo.max = static_cast<float>(std::atof(words[2].c_str()));
    std::vector<Map> maps;
    for (std::size_t k = 3; k < words.size(); ++k) {
        if (std::filesystem::is_directory(words[k]))
            add_directory(words[k], maps);
        else
            add_map(words[k], maps);
    }
    if (words.size() <= 3) add_usual_maps(maps);
    std::printf("%-24s %6s %10s %9s %8s %8s %8s %8s\n", "map", "growth", "bytes", "change", "mean", "p99.9", "largest",
                "seconds");
    std::vector<Point> plain;
    double mean = 0.0;  // of all maps
    for (const Map& map : maps) {
        plain.push_back(pack_map(map, options, 0.0));
        mean += plain.back().mean / static_cast<double>(maps.size());
    }
    std::array<Point, kGrowths.size()> pooled;
    for (std::size_t m = 0; m < maps.size(); ++m) {
        for (std::size_t k = 0; k < kGrowths.size(); ++k) {
            const double growth = 0.01 * kGrowths[k] * (one_mean ? mean : plain[m].mean);
            const Point point = k == 0 ? plain[m] : pack_map(maps[m], options, growth);
            print(maps[m].name, kGrowths[k], point, plain[m]);
            pooled[k].bytes += point.bytes;
            pooled[k].mean += point.mean / static_cast<double>(maps.size());
            pooled[k].most_999 += point.most_999 / static_cast<double>(maps.size());
            pooled[k].largest += point.largest / static_cast<double>(maps.size());
            pooled[k].seconds += point.seconds;
        }
    }
    for (std::size_t k = 0; k < kGrowths.size(); ++k) print("pooled", kGrowths[k], pooled[k], pooled[0]);
    return 0;
}
