// SPDX-License-Identifier: Apache-2.0
// eac_bench: EAC RG11 beside BC5 and DXT5nm, at every effort: speed on one thread, and the angle to the map.
//
//     eac_bench [ENCODER.so]
//
// The maps are those of encode_bench; angles are means over a map. Times are processor time on one thread, the median
// of several runs, without reading the maps. Errors are those of our decoder. ENCODER.so, another encoder of EAC RG11,
// has the function that encode_bench describes.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include <dlfcn.h>

#include "bench/encode_maps.h"
#include "kernels/encode.h"
#include "rows/codecs.h"

namespace {

using namespace bench;

using EncodeFunction = void(const std::uint8_t* rgba, int width, int height, std::size_t pitch, std::uint8_t* blocks);

struct Row {
    tex::Encoding encoding;
    tex::Effort effort;
    EncodeFunction* other = nullptr;  // another encoder instead of ours
    double seconds = 0;
    double angle = 0, p999 = 0;  // sums over the maps
};

double encode(const Map& map, const Row& row, std::vector<std::byte>& blocks) {
    const int repeats = row.effort == tex::Effort::best ? 1 : row.effort == tex::Effort::normal ? 2 : 8;
    std::vector<double> seconds;
    for (int run = 0; run < (row.effort == tex::Effort::best ? 1 : 3); ++run) {
        const double start = processor_seconds();
        for (int repeat = 0; row.other != nullptr && repeat < repeats; ++repeat) {
            row.other(map.rgba8.data(), map.width, map.height, static_cast<std::size_t>(map.width) * 4,
                      reinterpret_cast<std::uint8_t*>(blocks.data()));
        }
        for (int j = 0; row.other == nullptr && j < map.height; j += 4) {
            tex::BlockRow rows;
            for (int k = 0; k < 4; ++k) {
                rows.x[k] = map.normals.x.row(j + k);
                rows.y[k] = map.normals.y.row(j + k);
            }
            rows.width = map.width;
            std::byte* out = blocks.data() + 16 * static_cast<std::ptrdiff_t>(j / 4) * (map.width / 4);
            for (int repeat = 0; repeat < repeats; ++repeat)
                tex::encode_blocks(rows, {row.encoding, tex::YAxis::up, row.effort}, out);
        }
        seconds.push_back((processor_seconds() - start) / repeats);
    }
    return median(seconds);
}

// Adds the mean and the 99.9th percentile of the angles, in degrees.
void add_angles(const Map& map, std::vector<std::byte> blocks, Row& row) {
    tex::Texture texture;
    texture.format = tex::encoding_info(row.encoding).format;
    texture.swizzle = tex::encoding_info(row.encoding).swizzle;
    texture.levels.push_back({{map.width, map.height}, std::move(blocks)});
    const auto image = tex::decode(texture, 0);
    if (!image) return;
    const auto plane = [&](tex::Component component) -> const tex::Plane<float>& {
        const auto at = std::find(texture.swizzle.begin(), texture.swizzle.end(), component) - texture.swizzle.begin();
        return image->planes[static_cast<std::size_t>(at)];
    };
    const tex::Plane<float>& x = plane(tex::Component::x);
    const tex::Plane<float>& y = plane(tex::Component::y);
    const bool is_signed = tex::format_info(texture.format).sample == tex::SampleKind::snorm;
    const auto component = [&](float v) {
        return is_signed ? static_cast<double>(v) : 2.0 * static_cast<double>(v) - 1.0;
    };
    std::vector<float> angles;
    double sum = 0;
    for (int j = 0; j < map.height; ++j) {
        for (int i = 0; i < map.width; ++i) {
            const double p[2] = {map.normals.x.at(i, j), map.normals.y.at(i, j)};
            const double e[2] = {component(x.at(i, j)), component(y.at(i, j))};
            const double pz = std::sqrt(1.0 - std::min(1.0, p[0] * p[0] + p[1] * p[1]));
            const double ez = std::sqrt(1.0 - std::min(1.0, e[0] * e[0] + e[1] * e[1]));
            const double cross = std::hypot(p[1] * ez - pz * e[1], pz * e[0] - p[0] * ez, p[0] * e[1] - p[1] * e[0]);
            angles.push_back(
                static_cast<float>(std::atan2(cross, p[0] * e[0] + p[1] * e[1] + pz * ez) * 57.29577951308232));
            sum += static_cast<double>(angles.back());
        }
    }
    row.angle += sum / static_cast<double>(angles.size());
    const auto at = static_cast<std::ptrdiff_t>(0.999 * static_cast<double>(angles.size() - 1));
    std::nth_element(angles.begin(), angles.begin() + at, angles.end());
    row.p999 += static_cast<double>(angles[static_cast<std::size_t>(at)]);
}

}  // namespace

int main(int argc, char** argv) {
    std::vector<Map> maps;
    add_usual_maps(maps);
    if (maps.empty()) return 3;
    std::vector<Row> rows;
    for (const tex::Encoding encoding :
         {tex::Encoding::eac_rg11, tex::Encoding::eac_rg11_snorm, tex::Encoding::bc5, tex::Encoding::dxt5nm}) {
        for (const auto& effort : tex::kEffortNames) rows.push_back({encoding, effort.value});
    }
    if (argc > 1) {
        void* const library = dlopen(argv[1], RTLD_NOW);
        void* const symbol = library != nullptr ? dlsym(library, "encode") : nullptr;
        if (symbol == nullptr) {
            std::fprintf(stderr, "%s\n", dlerror());
            return 2;
        }
        rows.push_back({tex::Encoding::eac_rg11, tex::Effort::fast, reinterpret_cast<EncodeFunction*>(symbol)});
    }
    double texels = 0;
    for (const Map& map : maps) {
        texels += 16.0 * map.blocks();
        std::printf("%-28s", map.name.c_str());
        for (Row& row : rows) {
            std::vector<std::byte> blocks(static_cast<std::size_t>(map.blocks()) * 16);
            row.seconds += encode(map, row, blocks);
            const double before = row.angle;
            add_angles(map, std::move(blocks), row);
            std::printf(" %7.4f", row.angle - before);
        }
        std::printf("\n");
        std::fflush(stdout);
    }
    std::printf("\n| encoding | effort | Mtexel/s | mean angle | p99.9 angle |\n|---|---|---|---|---|\n");
    const auto count = static_cast<double>(maps.size());
    for (const Row& row : rows) {
        const double speed = texels / row.seconds * 1e-6;
        std::printf("| %s | %s | %.*f | %.3f | %.2f |\n",
                    std::string(tex::name_of(tex::kEncodingNames, row.encoding)).c_str(),
                    row.other != nullptr ? argv[1] : std::string(tex::name_of(tex::kEffortNames, row.effort)).c_str(),
                    speed < 20 ? 1 : 0, speed, row.angle / count, row.p999 / count);
    }
    return 0;
}
