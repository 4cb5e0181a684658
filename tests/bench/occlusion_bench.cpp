// SPDX-License-Identifier: Apache-2.0
// occlusion_bench: what the surface of heights hides: processor time and memory from 1024x1024 to 8192x8192 for 8 to 64
// directions, and, on crops of maps of ../shared/data, the error beside brute force for each number of directions, and
// the difference from SAGA's Sky View Factor where saga_cmd is found (Debian's package saga).

#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <ios>
#include <string>
#include <utility>
#include <vector>

#include <tex/bake.h>
#include <tex/file.h>
#include <tex/surface.h>

#include "reference/occlusion.h"
#include "scratch.h"
#include "unit/fields.h"

namespace {

using namespace tex;

double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

void print_times(int largest) {
    std::printf(
        "| extent | directions | maps | s of the processor | ns a texel and direction | peak, bytes a texel |\n");
    std::printf("|---|---|---|---|---|---|\n");
    for (int size = 1024; size <= largest; size *= 2) {
        const HeightField field = fields::field_of({size, size}, 20.0f, Wrap::repeat, [](int i, int j) {
            return std::sin(0.01 * i + 0.003 * j) + 0.2 * std::sin(0.2 * i) * std::sin(0.15 * j) +
                   0.05 * fields::noise(i, j);
        });
        for (const int directions : {8, 16, 32, 64, -16}) {  // below 0: all maps
            const bool all = directions < 0;
            const OcclusionOptions options{std::abs(directions), 0.0f, true, all, all};
            double best = 1e9;
            for (int run = 0; run < (size < 4096 ? 3 : 1); ++run) {
                const double begin = processor_seconds();
                if (!occlusion(field, options)) return;
                best = std::min(best, processor_seconds() - begin);
            }
            rusage usage{};
            getrusage(RUSAGE_SELF, &usage);
            const double texels = static_cast<double>(size) * size;
            std::printf("| %dx%d | %d | %s | %.2f | %.1f | %.1f |\n", size, size, options.directions,
                        all ? "all three" : "occlusion", best, best * 1e9 / texels / options.directions,
                        static_cast<double>(usage.ru_maxrss) * 1024 / texels);
            std::fflush(stdout);
        }
    }
}

struct Map {
    const char* file;  // below ../shared/data
    float bumpiness;
    int column, row;
};

constexpr Map kMaps[] = {
    {"height/metal_plate_disp_1k_1024x1024_u16.png", 40.0f, 100, 100},
    {"height/metal_plate_disp_1k_1024x1024_u16.png", 8.0f, 100, 100},
    {"height/dem_puget_sound_1025x1025_u16.png", 40.0f, 200, 300},
    {"height/dem_mt_fuji_smart_512x512_u16.png", 40.0f, 100, 100},
    {"height/materialx_plain_sphere_pyramid_512x512_u8.png", 40.0f, 0, 0},
    {"height/marble_tiles_600x600_u8.jpg", 10.0f, 100, 0},
    {"height/urho_heightmap_1025x1025_u8.png", 40.0f, 300, 300},
    {"height/winding_valley_513x513_u8.png", 40.0f, 100, 100},
    {"height/canyon_4096x4096_rgb8_equal.jpg", 40.0f, 1000, 1000},
    {"pairs/Bricks102/height.jpg", 20.0f, 100, 50},
    {"pairs/Tiles036/height.jpg", 20.0f, 100, 100},
    {"pairs/bevy_cube/height_INVERTED.png", 10.0f, 0, 0},
};

// Where the reference looks round: 100 texels of a crop of at most 256x256.
void print_errors() {
    const std::filesystem::path folder = TEX_SOURCE_DIR "/../shared/data";
    if (!std::filesystem::exists(folder)) return;
    std::printf("\n| map | bumpiness | directions | occlusion: mean | p99 | sky view: mean | p99 |\n");
    std::printf("|---|---|---|---|---|---|---|\n");
    for (const Map& map : kMaps) {
        const auto image = read_image((folder / map.file).string());
        if (!image) continue;
        const auto whole = height_field(*image);
        if (!whole) continue;
        const Extent extent{std::min(256, whole->height.extent().width - map.column),
                            std::min(256, whole->height.extent().height - map.row)};
        const HeightField field = fields::field_of(extent, map.bumpiness, Wrap::repeat, [&](int i, int j) {
            return static_cast<double>(whole->height.at(map.column + i, map.row + j));
        });
        const auto normals = bake(field);
        if (!normals) continue;
        std::vector<std::pair<int, int>> places;
        std::vector<reference::Sky> truth;
        for (int k = 0; k < 100; ++k) {
            const int i = static_cast<int>(fields::noise(k, 1) * extent.width);
            const int j = static_cast<int>(fields::noise(k, 2) * extent.height);
            const auto z = static_cast<double>(normals->z.at(i, j));
            places.emplace_back(i, j);
            truth.push_back(reference::sky_of(field, i, j, -static_cast<double>(normals->x.at(i, j)) / z,
                                              -static_cast<double>(normals->y.at(i, j)) / z, 512));
        }
        for (const int directions : {8, 16, 32, 64, 128}) {
            const auto maps = occlusion(field, {directions, 0.0f, true, true, false});
            if (!maps) continue;
            std::vector<double> dark, sky;
            double dark_sum = 0.0, sky_sum = 0.0;
            for (std::size_t k = 0; k < places.size(); ++k) {
                const auto [i, j] = places[k];
                dark.push_back(std::abs(static_cast<double>(maps->occlusion.at(i, j)) - truth[k].occlusion));
                sky.push_back(std::abs(static_cast<double>(maps->sky_view.at(i, j)) - truth[k].sky_view));
                dark_sum += dark.back() / static_cast<double>(places.size());
                sky_sum += sky.back() / static_cast<double>(places.size());
            }
            std::sort(dark.begin(), dark.end());
            std::sort(sky.begin(), sky.end());
            const std::size_t p99 = dark.size() - 2;
            std::printf("| %s | %g | %d | %.4f | %.4f | %.4f | %.4f |\n",
                        std::filesystem::path(map.file).parent_path().filename() == "height"
                            ? std::filesystem::path(map.file).stem().string().c_str()
                            : std::filesystem::path(map.file).parent_path().filename().string().c_str(),
                        static_cast<double>(map.bumpiness), directions, dark_sum, dark[p99], sky_sum, sky[p99]);
        }
        std::fflush(stdout);
    }
}

// SAGA's grids: a header of text, and floats with the lowest row first.
void write_grid(const std::string& name, const HeightField& field) {
    const Extent extent = field.height.extent();
    std::ofstream(name + ".sgrd") << "NAME = h\nDATAFORMAT = FLOAT\nBYTEORDER_BIG = FALSE\nPOSITION_XMIN = 0\n"
                                  << "POSITION_YMIN = 0\nCELLCOUNT_X = " << extent.width
                                  << "\nCELLCOUNT_Y = " << extent.height << "\nCELLSIZE = 1\nZ_FACTOR = 1\n"
                                  << "NODATA_VALUE = -99999\nTOPTOBOTTOM = FALSE\n";
    std::ofstream data(name + ".sdat", std::ios::binary);
    for (int j = extent.height - 1; j >= 0; --j) {
        for (int i = 0; i < extent.width; ++i) {
            const float height = field.height.at(i, j) * field.bumpiness_x;
            data.write(reinterpret_cast<const char*>(&height), sizeof height);
        }
    }
}

// What SAGA makes of the same heights, weighted like our occlusion (Boehner, Antonic: Land-Surface Parameters Specific
// to Topo-Climatology, 2009); of a terrain's inside, as its ground ends at the border.
void print_saga() {
    if (std::system("saga_cmd --version > /dev/null 2>&1") != 0) return;
    const auto image = read_image(TEX_SOURCE_DIR "/../shared/data/height/dem_puget_sound_1025x1025_u16.png");
    const auto whole = image ? height_field(*image) : Result<PictureHeights>(image.error());
    if (!whole) return;
    const Scratch scratch;
    const std::string name = scratch.path("saga");
    std::printf(
        "\n| size | directions | SAGA: radius | s of the processor | ours | mean difference | p99 "
        "|\n|---|---|---|---|---|---|---|\n");
    struct Case {
        int size, directions, radius;  // of SAGA's; ours has no limit
    };
    for (const auto [size, directions, radius] : {Case{256, 32, 100000}, {512, 32, 100000}, {1024, 16, 256}}) {
        const HeightField field = fields::field_of({size, size}, 40.0f, Wrap::clamp, [&](int i, int j) {
            return static_cast<double>(
                whole->height.at(std::min(200, 1025 - size) + i, std::min(300, 1025 - size) + j));
        });
        write_grid(name, field);
        rusage before{}, after{};
        getrusage(RUSAGE_CHILDREN, &before);
        const std::string command = "OMP_NUM_THREADS=1 saga_cmd ta_lighting 3 -DEM " + name + ".sgrd -VISIBLE " + name +
                                    "_v -SVF " + name + "_s -RADIUS " + std::to_string(radius) + " -NDIRS " +
                                    std::to_string(directions) + " > /dev/null 2>&1";
        if (std::system(command.c_str()) != 0) return;
        getrusage(RUSAGE_CHILDREN, &after);
        const auto seconds = [](const rusage& usage) {
            return static_cast<double>(usage.ru_utime.tv_sec) + 1e-6 * static_cast<double>(usage.ru_utime.tv_usec);
        };
        double own = 1e9;  // the least of three: the first one waits for pages of memory
        auto maps = occlusion(field, {directions, 0.0f, true, false, false});
        for (int run = 0; run < 3; ++run) {
            const double begin = processor_seconds();
            maps = occlusion(field, {directions, 0.0f, true, false, false});
            own = std::min(own, processor_seconds() - begin);
        }
        std::vector<float> theirs(static_cast<std::size_t>(size) * static_cast<std::size_t>(size));
        std::ifstream data(name + "_s.sdat", std::ios::binary);
        if (!maps ||
            !data.read(reinterpret_cast<char*>(theirs.data()), static_cast<std::streamsize>(4 * theirs.size())))
            return;
        std::vector<double> differences;
        double sum = 0.0;
        for (int j = size / 8; j < size - size / 8; ++j) {
            for (int i = size / 8; i < size - size / 8; ++i) {
                const float saga = theirs[static_cast<std::size_t>((size - 1 - j) * size + i)];
                differences.push_back(std::abs(static_cast<double>(saga - maps->occlusion.at(i, j))));
                sum += differences.back();
            }
        }
        std::sort(differences.begin(), differences.end());
        std::printf("| %d | %d | %d | %.2f | %.3f | %.4f | %.4f |\n", size, directions, radius,
                    seconds(after) - seconds(before), own, sum / static_cast<double>(differences.size()),
                    differences[differences.size() * 99 / 100]);
    }
}

}  // namespace

// An argument: the largest extent, 8192 without; or saga, for that part alone.
int main(int count, char** arguments) {
    if (count > 1 && std::string(arguments[1]) == "saga") {
        print_saga();
        return 0;
    }
    print_errors();
    print_saga();
    std::printf("\n");
    print_times(count > 1 ? std::stoi(arguments[1]) : 8192);
}
