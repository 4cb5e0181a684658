// SPDX-License-Identifier: Apache-2.0
// wild_fill_bench: whether N215 prints its fix where it ought to, on clean maps of ../shared/data/wild4.
//
//     wild_fill_bench [MAPS]        the number of maps (80)
//
// Into the middle of each map a sheet of round and straight charts is cut, at most 512 x 512 texels. "Background" fills
// the rest with one colour, with edges as a filter makes them: there the fix is right. "Bevels" gives the charts an
// edge of two texels that leans outwards, 1.2 times as long as unit vectors; "strips" has no background at all, but
// bevels of four directions that are so long that no unit vector is near: there the fix would delete them. Each is
// stored as RGB, after JPEG of quality 75, as DXT5nm and as BC5. The table says of how many maps with N215 the fix is
// not printed, separately for the half that sets thresholds (the FNV-1a hash of the name is even).

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <tex/tex.h>

#include "bench/wild_maps.h"
#include "reference/damage.h"

namespace {

using namespace tex;
using namespace tex::reference;

// The distance from the edge of the nearest chart in texels, above 0 inside, and the direction to the outside.
struct Edge {
    double inside, x, y;
};

Edge edge_at(double i, double j) {
    constexpr double kCell = 96.0, kRadius = 36.0;
    const double x = std::fmod(i, kCell) - kCell / 2, y = std::fmod(j, kCell) - kCell / 2;
    const bool is_round = (static_cast<int>(i / kCell) + static_cast<int>(j / kCell)) % 2 == 0;
    if (is_round) {
        const double r = std::max(1e-6, std::sqrt(x * x + y * y));
        return {kRadius - r, x / r, y / r};
    }
    const double ax = std::abs(x), ay = std::abs(y);
    return ax > ay ? Edge{kRadius - ax, x > 0 ? 1.0 : -1.0, 0.0} : Edge{kRadius - ay, 0.0, y > 0 ? 1.0 : -1.0};
}

using Color = std::array<double, 3>;

// Mixes 3 x 3 samples of a texel, as renderers do at edges.
Codes painted(const Codes& codes, const std::function<std::optional<Color>(const Edge&)>& paint) {
    Codes result = codes;
    for (int j = 0; j < codes.extent.height; ++j) {
        for (int i = 0; i < codes.extent.width; ++i) {
            Color sum{};
            for (int k = 0; k < 9; ++k) {
                const auto color = paint(edge_at(i + (k % 3 - 1) / 3.0, j + (k / 3 - 1) / 3.0));
                for (std::size_t c = 0; c < 3; ++c) sum[c] += color ? (*color)[c] : codes.at(i, j, static_cast<int>(c));
            }
            for (std::size_t c = 0; c < 3; ++c)
                result.at(i, j, static_cast<int>(c)) = static_cast<unsigned char>(std::lround(sum[c] / 9.0));
        }
    }
    return result;
}

// A normal that leans outwards, of this length.
Color leaning(const Edge& edge, double z, double length) {
    const double lean = std::sqrt(std::max(0.0, 1.0 - z * z));
    const auto code = [&](double c) { return std::min(255.0, std::max(0.0, 127.5 * (1.0 + length * c))); };
    return {code(lean * edge.x), code(-lean * edge.y), code(z)};
}

std::optional<Texture> stored_as(const Codes& codes, std::optional<Encoding> encoding) {
    if (!encoding) return texture_of(codes);
    UnpackOptions options;
    options.keep_length = true;
    auto chain = unpack(texture_of(codes), options);
    if (!chain) return std::nullopt;
    auto texture = pack(*chain, {*encoding, YAxis::up, Effort::fast});
    return texture ? std::optional(std::move(*texture)) : std::nullopt;
}

bool is_tune(const std::string& file) {
    std::uint32_t hash = 2166136261u;
    for (const char c : file) hash = (hash ^ static_cast<unsigned char>(c)) * 16777619u;
    return hash % 2 == 0;
}

struct Count {
    int speaks = 0, withheld = 0;
};

}  // namespace

int main(int argc, char** argv) {
    const auto wanted = static_cast<std::size_t>(argc > 1 ? std::atoi(argv[1]) : 80);
    struct Case {
        std::string name;
        std::function<Codes(const Codes&)> plant;
    };
    std::vector<Case> cases;
    const auto background = [](Color color, bool bevels) {
        return [=](const Codes& codes) {
            return painted(codes, [&](const Edge& edge) -> std::optional<Color> {
                if (edge.inside < 0.0) return color;
                if (bevels && edge.inside < 2.0) return leaning(edge, 0.5, 1.2);
                return std::nullopt;
            });
        };
    };
    for (const auto& [name, color] :
         {std::pair("black", Color{0, 0, 0}), std::pair("grey", Color{128, 128, 128}),
          std::pair("white", Color{255, 255, 255}), std::pair("blue 0", Color{128, 128, 0})}) {
        cases.push_back({std::string("background, ") + name, background(color, false)});
        cases.push_back({std::string("bevels, ") + name, background(color, true)});
    }
    cases.push_back(
        {"strips", [](const Codes& codes) {
             return painted(codes, [](const Edge& edge) -> std::optional<Color> {
                 return edge.inside > -4.0 && edge.inside < 0.0
                            ? std::optional(leaning({0.0, edge.x < 0 ? -0.8 : 0.8, edge.y < 0 ? -0.6 : 0.6}, 0.2, 1.35))
                            : std::nullopt;
             });
         }});
    const std::optional<Encoding> encodings[] = {std::nullopt, std::nullopt, Encoding::dxt5nm, Encoding::bc5};
    const char* const names[] = {"RGB", "JPEG 75", "DXT5nm", "BC5"};
    std::map<std::pair<std::string, int>, std::array<Count, 2>> counts;
    for (const std::string& file : clean_maps(wanted)) {
        const auto codes = middle_of(file);
        if (!codes) continue;
        for (const Case& one : cases) {
            const Codes planted = one.plant(*codes);
            for (int e = 0; e < 4; ++e) {
                const auto texture = stored_as(e == 1 ? jpeg(planted, 75) : planted, encodings[e]);
                if (!texture) return 1;
                const auto report = check(file, *texture, {});
                if (!report) return 1;
                for (const Finding& finding : report->findings) {
                    if (finding.rule->id != "N215") continue;
                    Count& count = counts[{one.name, e}][is_tune(file) ? 0 : 1];
                    ++count.speaks;
                    count.withheld += finding.fix_harms.empty() ? 0 : 1;
                }
            }
        }
    }
    std::printf("%-22s", "no fix is printed");
    for (const char* const name : names) std::printf(" %16s", name);
    std::printf("\n");
    for (const Case& one : cases) {
        std::printf("%-22s", one.name.c_str());
        for (int e = 0; e < 4; ++e) {
            const auto& [tune, held] = counts[{one.name, e}];
            std::printf("  %3d/%-3d %3d/%-3d", tune.withheld, tune.speaks, held.withheld, held.speaks);
        }
        std::printf("\n");
    }
    return 0;
}
