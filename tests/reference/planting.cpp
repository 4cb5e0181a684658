// SPDX-License-Identifier: Apache-2.0

#include "reference/planting.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "reference/damage.h"

namespace tex::reference {
namespace {

constexpr int kMost = 512;  // texels along a side: time matters more
constexpr int kMostForHeights = 256;
constexpr int kGreyLevels = 256;
constexpr int kFewestLevels = 8;
constexpr double kVisibleStep = 5.0 / 255.0;  // of slopes
constexpr double kVisibleSeam = 2.0;
constexpr double kFewHoles = 0.005;
constexpr double kVisibleShortness = 0.0125;  // of vectors: a code and a half of z

// The largest part of the map, from its corner, whose sides are powers of two.
NormalMap power_of_two_part(const NormalMap& map, int most) {
    const auto side = [&](int n) { return static_cast<int>(std::bit_floor(static_cast<unsigned>(std::min(n, most)))); };
    return crop(map, 0, 0, {side(map.extent().width), side(map.extent().height)});
}

NormalMap turned(NormalMap map, bool negate_y) {
    for (int j = 0; negate_y && j < map.extent().height; ++j) {
        for (int i = 0; i < map.extent().width; ++i) map.y.at(i, j) = -map.y.at(i, j);
    }
    return map;
}

// The mean length of the averages of 2^level x 2^level vectors, for the levels of 16 texels and more: the least.
double shortest_average(const NormalMap& map) {
    double least = 1.0;
    for (int size = 2; size * 16 <= std::min(map.extent().width, map.extent().height); size *= 2) {
        double sum = 0.0, count = 0.0;
        for (int j = 0; j + size <= map.extent().height; j += size) {
            for (int i = 0; i + size <= map.extent().width; i += size) {
                double x = 0.0, y = 0.0, z = 0.0;
                for (int k = 0; k < size * size; ++k) {
                    x += map.x.at(i + k % size, j + k / size);
                    y += map.y.at(i + k % size, j + k / size);
                    z += map.z.at(i + k % size, j + k / size);
                }
                sum += std::sqrt(x * x + y * y + z * z) / (size * size);
                count += 1.0;
            }
        }
        least = std::min(least, sum / count);
    }
    return least;
}

// The mean step across the border over the mean step inside, as SOURCES.md measures tiling; the larger one of x and y,
// columns and rows.
double border_ratio(const NormalMap& map) {
    const Extent e = map.extent();
    double worst = 0.0;
    for (const Plane<float>* plane : {&map.x, &map.y}) {
        double inner = 0.0, right = 0.0, bottom = 0.0;
        for (int j = 0; j < e.height; ++j) {
            for (int i = 0; i + 1 < e.width; ++i) inner += std::abs(plane->at(i + 1, j) - plane->at(i, j));
            right += std::abs(plane->at(0, j) - plane->at(e.width - 1, j));
        }
        for (int i = 0; i < e.width; ++i) bottom += std::abs(plane->at(i, 0) - plane->at(i, e.height - 1));
        inner /= static_cast<double>(e.width - 1) * e.height;
        worst = std::max({worst, right / e.height / inner, bottom / e.width / inner});
    }
    return worst;
}

// The share of texels without a normal that has a slope. The rules leave out the texels around them.
double share_of_holes(const NormalMap& map) {
    double holes = 0.0;
    for (int j = 0; j < map.extent().height; ++j) {
        for (int i = 0; i < map.extent().width; ++i) holes += map.z.at(i, j) < 0.05f ? 1.0 : 0.0;
    }
    return holes / static_cast<double>(map.extent().texels());
}

Codes half_flipped(const Codes& codes) {
    const Codes flipped = flip_green(codes);
    Codes result = codes;
    for (int j = 0; j < codes.extent.height; ++j) {
        for (int i = 0; i < codes.extent.width / 2; ++i) result.at(i, j, 1) = flipped.at(i, j, 1);
    }
    return result;
}

// The texels in another order: noise of the map's own normals.
Codes shuffled(Codes codes) {
    unsigned state = 1;
    for (int k = static_cast<int>(codes.extent.texels()) - 1; k > 0; --k) {
        state = state * 1664525u + 1013904223u;
        const int other = static_cast<int>((std::uint64_t{state} * static_cast<unsigned>(k + 1)) >> 32);
        for (int c = 0; c < codes.channels; ++c)
            std::swap(codes.values[static_cast<std::size_t>(k * codes.channels + c)],
                      codes.values[static_cast<std::size_t>(other * codes.channels + c)]);
    }
    return codes;
}

// Parts of the map that do not meet themselves: the first one that shows a seam, as SOURCES.md measures tiling.
void plant_seam(const NormalMap& whole, std::vector<Planted>& all) {
    const Extent e = whole.extent();
    struct Part {
        int begin, size;  // sixteenths
    };
    for (const Part part : {Part{1, 14}, Part{2, 12}, Part{3, 8}, Part{5, 9}}) {
        const NormalMap cut = crop(whole, e.width * part.begin / 16, e.height * part.begin / 16,
                                   {std::max(1, e.width * part.size / 16), std::max(1, e.height * part.size / 16)});
        const bool visible = border_ratio(cut) >= kVisibleSeam;
        if (!visible && part.begin != 5) continue;
        all.push_back({"seam", "N307", texture_of(codes_of(cut)),
                       std::make_shared<const Texture>(texture_of(codes_of(whole))), std::nullopt, true, visible});
        return;
    }
}

}  // namespace

std::vector<Planted> plant_all(const NormalMap& whole, std::optional<YAxis> y, bool tiles, bool blocks) {
    std::vector<Planted> all;
    const NormalMap map =
        crop(whole, 0, 0, {std::min(whole.extent().width, kMost), std::min(whole.extent().height, kMost)});
    const Codes codes = codes_of(map);
    const auto share = [](Texture texture) { return std::make_shared<const Texture>(std::move(texture)); };
    const auto plain = share(texture_of(codes));
    const auto add = [&](std::string damage, std::string rules, Texture damaged,
                         std::shared_ptr<const Texture> intact) -> Planted& {
        return all.emplace_back(Planted{std::move(damage), std::move(rules), std::move(damaged), std::move(intact),
                                        std::nullopt, false, true});
    };
    if (y) {
        add("green swapped", "N401", texture_of(flip_green(codes)), plain).y = y;
        add("green swapped in one half", "N402", texture_of(half_flipped(codes)), plain);
    }
    add("sRGB-encoded", "N302", texture_of(srgb_encode(codes)), plain);
    add("sRGB-decoded", "N301", texture_of(srgb_decode(codes)), plain);
    add("premultiplied", "N303", texture_of(with_alpha(codes, true)), share(texture_of(with_alpha(codes, false))));
    add("x and y exchanged", "N308", texture_of(exchange(codes, 0, 1)), plain);
    add("x and z exchanged", "N308", texture_of(exchange(codes, 0, 2)), plain);
    for (const double angle : {30.0, -50.0}) {
        add("turned by " + std::to_string(static_cast<int>(angle)) + " degrees", "N309",
            texture_of(codes_of(turn_picture(map, angle))), plain);
    }
    add("texels shuffled", "N310", texture_of(shuffled(codes)), plain).visible = share_of_holes(map) < kFewHoles;
    if (!blocks) add("BC1 before", "N306", texture_of(bc1(codes)), plain);
    add("JPEG, quality 50", "N304", texture_of(jpeg(codes, 50)), plain);

    const NormalMap base = power_of_two_part(map, kMost);
    const auto chain = share(texture_of(chain_of(base, ChainFault::none)));
    add("mips not renormalised", "N501", texture_of(chain_of(base, ChainFault::not_normalised)), chain).visible =
        shortest_average(base) < 1.0 - kVisibleShortness;
    add("mips shifted", "N502 N503", texture_of(chain_of(base, ChainFault::shifted)), chain);
    add("mips of another image", "N502", texture_of(chain_of(base, ChainFault::other_image)), chain);

    const NormalMap part = turned(power_of_two_part(map, kMostForHeights), y && *y == YAxis::down);
    const Heights heights = reference::integrate(part);
    const auto baked = share(texture_of(codes_of(from_heights(heights, 0))));
    const auto shows = [&](int levels) { return heights.slope_step(levels) >= kVisibleStep; };
    add("banding of 8-bit heights", "N305", texture_of(codes_of(from_heights(heights, kGreyLevels))), baked).visible =
        shows(kGreyLevels);
    if (!shows(kGreyLevels)) {
        // These heights in the largest part of the 8 bits whose steps show.
        int levels = kGreyLevels / 2;
        while (!shows(levels) && levels > kFewestLevels) levels /= 2;
        add("banding, part of 8 bits", "N305", texture_of(codes_of(from_heights(heights, levels))), baked).visible =
            shows(levels);
    }
    if (tiles) plant_seam(whole, all);
    return all;
}

}  // namespace tex::reference
