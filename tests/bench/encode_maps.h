// SPDX-License-Identifier: Apache-2.0
// encode_maps.h: the maps of encode_bench and eac_bench, and processor time.

#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <tex/tex.h>

namespace bench {

inline double processor_seconds() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

struct Map {
    std::string name;
    tex::NormalMap normals;
    int width, height;                // whole blocks
    std::vector<std::uint8_t> rgba8;  // for the other encoders
    [[nodiscard]] int blocks() const { return width / 4 * (height / 4); }
};

inline double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

// Adds a map whose x and y are codes of 8 bits.
inline void add_codes(Map map, std::vector<Map>& maps) {
    for (int j = 0; j < map.height; ++j) {
        for (int i = 0; i < map.width; ++i) {
            const auto code = [](float n) { return static_cast<std::uint8_t>(n * 127.5f + 128.0f); };
            map.rgba8.insert(map.rgba8.end(), {255, code(map.normals.y.at(i, j)), 0, code(map.normals.x.at(i, j))});
        }
    }
    maps.push_back(std::move(map));
}

inline void add_map(const std::filesystem::path& path, std::vector<Map>& maps) {
    const tex::Result<tex::Image> image = tex::read_image(path.string());
    if (!image) {
        std::fprintf(stderr, "%s\n", image.error().message().c_str());
        return;
    }
    tex::Result<tex::NormalMap> normals = tex::unpack(*image, {});
    if (!normals || normals->extent().width < 4 || normals->extent().height < 4) return;
    Map map{path.filename().string(), std::move(*normals), 0, 0, {}};
    map.width = map.normals.extent().width / 4 * 4;
    map.height = map.normals.extent().height / 4 * 4;
    if (!map.name.starts_with("normal"))
        map.name = path.stem().string();
    else
        map.name = path.parent_path().filename().string() + "/" + path.stem().string();
    // x and y as stored. They come from the picture because unpack() normalises.
    for (int j = 0; j < map.height; ++j) {
        for (int i = 0; i < map.width; ++i) {
            map.normals.x.at(i, j) = 2.0f * image->planes[0].at(i, j) - 1.0f;
            map.normals.y.at(i, j) = 2.0f * image->planes[1].at(i, j) - 1.0f;
        }
    }
    add_codes(std::move(map), maps);
}

// Adds the normals of a height map, rounded to 8 bits as in the other maps.
inline void add_heights(const std::string& path, std::vector<Map>& maps) {
    const tex::Result<tex::Image> image = tex::read_image(path);
    auto field = image ? tex::height_field(*image, {}) : tex::Result<tex::PictureHeights>(image.error());
    if (!field) {
        std::fprintf(stderr, "%s\n", field.error().message().c_str());
        return;
    }
    field->bumpiness_x = field->bumpiness_y = 8.0f;
    tex::Result<tex::NormalMap> normals = tex::bake(*field);
    if (!normals) return;
    Map map{std::filesystem::path(path).stem().string(), std::move(*normals), 0, 0, {}};
    map.width = map.normals.extent().width / 4 * 4;
    map.height = map.normals.extent().height / 4 * 4;
    for (tex::Plane<float>* plane : {&map.normals.x, &map.normals.y}) {
        for (int j = 0; j < map.height; ++j) {
            for (int i = 0; i < map.width; ++i)
                plane->at(i, j) = std::round(127.5f * plane->at(i, j) + 127.5f) / 127.5f - 1.0f;
        }
    }
    add_codes(std::move(map), maps);
}

inline void add_directory(const std::filesystem::path& directory, std::vector<Map>& maps) {
    std::vector<std::filesystem::path> paths;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(directory)) {
        const std::filesystem::path& path = entry.path();
        const bool pair = path.string().find("/pairs/") != std::string::npos;
        const bool eight_bits = path.extension() != ".exr";
        const bool copy = path.parent_path().filename() == "derived";
        if (entry.is_regular_file() && eight_bits && !copy && (!pair || path.filename().string().starts_with("normal")))
            paths.push_back(path);
    }
    std::sort(paths.begin(), paths.end());
    for (const std::filesystem::path& path : paths) add_map(path, maps);
}

// Adds the maps in ../shared/data/normal and pairs beside the source tree or, if they are missing, bakes of the
// samples.
inline void add_usual_maps(std::vector<Map>& maps) {
    for (const char* folder : {"/../shared/data/normal", "/../shared/data/pairs"}) {
        if (std::filesystem::is_directory(std::string(TEX_SOURCE_DIR) + folder))
            add_directory(std::string(TEX_SOURCE_DIR) + folder, maps);
    }
    if (!maps.empty()) return;
    std::fprintf(stderr, "no maps; bakes of the samples instead, which the figures of RESULTS.md do not contain\n");
    for (const char* name : {"bricks", "hemisphere", "ramp", "waves"})
        add_heights(TEX_SOURCE_DIR "/samples/" + std::string(name) + ".png", maps);
}

}  // namespace bench
