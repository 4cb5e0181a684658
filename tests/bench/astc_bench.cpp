// SPDX-License-Identifier: Apache-2.0
// astc_bench [ENCODING | EFFORT] ...: ASTC beside the other encodings for phones and desktops: bits a texel, speed on
// one thread, and the angle to the map. The maps are those of encode_bench, but at most 256x256 texels from their
// middle, because the best efforts are slow. Errors are those of our decoder. (ASTC.md compares with astcenc.)

#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include <tex/check.h>
#include <tex/pack.h>

#include "bench/encode_maps.h"

namespace {

using namespace bench;

constexpr int kMostTexels = 256;  // along a side

tex::MipChain middle_of(const Map& map) {
    const tex::Extent extent{std::min(map.width, kMostTexels), std::min(map.height, kMostTexels)};
    const int left = (map.width - extent.width) / 2, top = (map.height - extent.height) / 2;
    tex::MipChain chain;
    chain.levels.emplace_back(extent);
    for (int j = 0; j < extent.height; ++j) {
        std::copy_n(map.normals.x.row(top + j) + left, extent.width, chain.levels[0].x.row(j));
        std::copy_n(map.normals.y.row(top + j) + left, extent.width, chain.levels[0].y.row(j));
        for (int i = 0; i < extent.width; ++i)
            chain.levels[0].z.at(i, j) = tex::reconstruct_z(chain.levels[0].x.at(i, j), chain.levels[0].y.at(i, j));
    }
    return chain;
}

struct Row {
    tex::Encoding encoding;
    tex::Effort effort;
    double seconds = 0, texels = 0, bytes = 0;
    double mean = 0, p999 = 0;  // sums over the maps
};

bool measure(const tex::MipChain& chain, Row& row) {
    tex::PackOptions options;
    options.encoding = row.encoding;
    options.effort = row.effort;
    const double start = processor_seconds();
    const auto texture = tex::pack(chain, options, {1, {}});
    row.seconds += processor_seconds() - start;
    if (!texture) return false;
    const auto unpacked = tex::unpack(*texture);
    if (!unpacked) return false;
    const auto compared = tex::compare(chain.levels.front(), unpacked->levels.front());
    if (!compared) return false;
    row.texels += static_cast<double>(chain.levels.front().extent().texels());
    row.bytes += static_cast<double>(texture->levels.front().bytes.size());
    row.mean += compared->error.mean;
    row.p999 += compared->error.p999;
    return true;
}

}  // namespace

int main(int argc, char** argv) {
    using enum tex::Encoding;
    const std::vector<std::string> words(argv + 1, argv + argc);  // all encodings, all efforts, unless some are named
    const auto is_asked = [&](const auto& names, auto value) {
        bool any = false, one = false;
        for (const std::string& word : words) {
            const auto named = tex::find_by_name(names, word);
            any = any || named;
            one = one || (named && *named == value);
        }
        return one || !any;
    };
    std::vector<Map> maps;
    add_usual_maps(maps);
    if (maps.empty()) return 3;
    std::vector<Row> rows;
    for (const tex::Encoding encoding : {dxt5nm, bc5, eac_rg11, astc_4x4, astc_5x5, astc_6x6, astc_8x8}) {
        for (const auto& effort : tex::kEffortNames) {
            if (is_asked(tex::kEncodingNames, encoding) && is_asked(tex::kEffortNames, effort.value))
                rows.push_back({encoding, effort.value});
        }
    }
    std::printf(
        "| encoding | effort | bits a texel | Mtexel/s | mean angle | p99.9 angle |\n|---|---|---|---|---|---|\n");
    for (Row& row : rows) {
        for (const Map& map : maps) {
            if (!measure(middle_of(map), row)) return 1;
        }
        const auto count = static_cast<double>(maps.size());
        const double speed = row.texels / row.seconds * 1e-6;
        std::printf("| %s | %s | %.2f | %.*f | %.3f | %.2f |\n",
                    std::string(tex::name_of(tex::kEncodingNames, row.encoding)).c_str(),
                    std::string(tex::name_of(tex::kEffortNames, row.effort)).c_str(), 8.0 * row.bytes / row.texels,
                    speed < 20 ? 2 : 0, speed, row.mean / count, row.p999 / count);
        std::fflush(stdout);
    }
    return 0;
}
