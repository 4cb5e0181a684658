// SPDX-License-Identifier: Apache-2.0
// wild_damage_bench: which damages the rules of check.h find in 40 clean maps of ../shared/data/wild4.
//
//     wild_damage_bench [MAPS]        the number of maps (40)
//
// The maps are those that labels.tsv calls normal and that have no finding there, sorted by name, evenly spread. Each
// damage is planted into the middle of the map, at most 512 x 512 texels, and stored as RGB, as DXT5nm and as BC5. The
// table has, for each of the three, how many maps have a finding of the rule that names the damage, of those that do
// not have it without the damage. Runs anywhere where the data are; prints nothing else.

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <functional>
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

struct Damage {
    const char* name;
    const char* rules;  // one of them names it
    std::function<Codes(const Codes&)> plant;
};

Codes each(Codes codes, const std::function<void(unsigned char*)>& change) {
    for (std::size_t k = 0; k < codes.values.size(); k += 3) change(&codes.values[k]);
    return codes;
}

// A quarter turn of the picture, without its vectors. The map is square.
Codes quarter_turn(const Codes& codes) {
    Codes turned = codes;
    for (int j = 0; j < codes.extent.height; ++j) {
        for (int i = 0; i < codes.extent.width; ++i) {
            for (int c = 0; c < 3; ++c) turned.at(j, codes.extent.width - 1 - i, c) = codes.at(i, j, c);
        }
    }
    return turned;
}

const std::vector<Damage>& damages() {
    static const std::vector<Damage> kDamages = {
        {"green flipped", "N401", flip_green},
        {"BGR", "N308", [](const Codes& c) { return exchange(c, 0, 2); }},
        {"sRGB encoded", "N302", srgb_encode},
        {"sRGB decoded", "N301", srgb_decode},
        {"turned by 90 degrees", "N308", quarter_turn},
        {"JPEG of quality 50", "N304", [](const Codes& c) { return jpeg(c, 50); }},
        {"JPEG of quality 75", "N304", [](const Codes& c) { return jpeg(c, 75); }},
        {"JPEG of quality 90", "N304", [](const Codes& c) { return jpeg(c, 90); }},
        {"x negated", "N401",
         [](const Codes& c) {
             return each(c, [](unsigned char* t) { t[0] = static_cast<unsigned char>(255 - t[0]); });
         }},
        {"x and y exchanged", "N308", [](const Codes& c) { return exchange(c, 0, 1); }},
        {"blue inverted", "N213 N220",
         [](const Codes& c) {
             return each(c, [](unsigned char* t) { t[2] = static_cast<unsigned char>(255 - t[2]); });
         }},
        {"premultiplied", "N303", [](const Codes& c) { return with_alpha(c, true); }},
    };
    return kDamages;
}

std::optional<Texture> stored_as(const Codes& codes, std::optional<Encoding> encoding) {
    if (!encoding) return texture_of(codes);
    NormalMap map(codes.extent);
    for (int j = 0; j < codes.extent.height; ++j) {
        for (int i = 0; i < codes.extent.width; ++i) {
            const auto component = [&](int c) { return static_cast<float>(codes.at(i, j, c)) / 127.5f - 1.0f; };
            map.x.at(i, j) = component(0);
            map.y.at(i, j) = component(1);
            map.z.at(i, j) = component(2);
        }
    }
    MipChain chain;
    chain.levels.push_back(std::move(map));
    auto texture = pack(chain, {*encoding, YAxis::up, Effort::fast});
    return texture ? std::optional(std::move(*texture)) : std::nullopt;
}

bool has(const CheckReport& report, const std::string& ids) {
    return std::any_of(report.findings.begin(), report.findings.end(),
                       [&](const Finding& finding) { return ids.find(finding.rule->id) != std::string::npos; });
}

}  // namespace

int main(int argc, char** argv) {
    const auto wanted = static_cast<std::size_t>(argc > 1 ? std::atoi(argv[1]) : 40);
    const std::optional<Encoding> encodings[] = {std::nullopt, Encoding::dxt5nm, Encoding::bc5};
    struct Count {
        int found = 0, all = 0;
    };
    std::vector<std::vector<Count>> counts(damages().size(), std::vector<Count>(std::size(encodings)));
    for (const std::string& file : clean_maps(wanted)) {
        const auto codes = middle_of(file);
        if (!codes) continue;
        for (std::size_t e = 0; e < std::size(encodings); ++e) {
            const auto intact = stored_as(*codes, encodings[e]);
            if (!intact) return 1;
            CheckOptions options;
            auto before = check(file, *intact, options);
            if (!before) return 1;
            options.require.y = before->y.y;
            for (std::size_t d = 0; d < damages().size(); ++d) {
                const Damage& damage = damages()[d];
                const Codes damaged = damage.plant(*codes);
                if (damaged.channels == 4 && encodings[e]) continue;  // alpha is x there
                if (std::string(damage.rules) == "N401" && !options.require.y) continue;
                const auto texture = stored_as(damaged, encodings[e]);
                if (!texture) return 1;
                const auto report = check(file, *texture, options);
                if (!report || has(*before, damage.rules)) continue;
                ++counts[d][e].all;
                counts[d][e].found += has(*report, damage.rules) ? 1 : 0;
            }
        }
    }
    std::printf("%-24s %10s %10s %10s\n", "damage", "RGB", "DXT5nm", "BC5");
    for (std::size_t d = 0; d < damages().size(); ++d) {
        std::printf("%-24s", damages()[d].name);
        for (const Count& count : counts[d]) std::printf(" %6d/%-3d", count.found, count.all);
        std::printf("\n");
    }
    return 0;
}
