// SPDX-License-Identifier: Apache-2.0

#include "reference/real_maps.h"

#include <algorithm>
#include <cstdint>
#include <utility>

namespace tex::reference {
namespace {

// The folder of a pair, else the file's stem; one name for both files of the field stones.
std::string picture_of(const std::string& path) {
    const auto slash = path.find('/');
    const std::string rest = path.substr(slash + 1);
    if (path.starts_with("pairs/")) return rest.substr(0, rest.find('/'));
    return rest.starts_with("fieldstone") ? "fieldstone" : rest.substr(0, rest.rfind('.'));
}

std::uint32_t fnv1a(const std::string& text) {
    std::uint32_t hash = 2166136261u;
    for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 16777619u;
    return hash;
}

}  // namespace

const std::vector<RealMap>& real_maps() {
    constexpr auto kUp = YAxis::up;
    constexpr auto kDown = YAxis::down;
    using enum LabelSource;
    static const std::vector<RealMap> maps = {
        {"pairs/Bricks102/normal_DX.jpg", kDown, name, true, true},
        {"pairs/Bricks102/normal_GL.jpg", kUp, name, true, true},
        {"pairs/oiio_bump/normal_YDOWN_half.exr", kDown, name, true, true},
        {"pairs/Tiles036/normal_DX.jpg", kDown, heights, true, true},
        {"pairs/d3d_pom_rocks/normal_rgb_height_a.tga", kUp, heights, true, false},
        {"pairs/d3d_pom_bump/normal_rgb_height_a.tga", kDown, heights, true, true},
        {"pairs/godot_cheese/normal_GL.png", kUp, heights, true, false},
        {"pairs/bevy_cube/normal_GL.png", kUp, heights, true, true},
        {"normal/panels_tangent_512_rgba.png", kDown, measured, true, false},
        {"normal/panels_OBJECTSPACE_512.png", std::nullopt, measured, false, false},
        {"normal/water1_256.tga", kDown, measured, true, true},
        {"normal/nm_balls_256.png", kDown, measured, true, true},
        {"normal/fieldstone_512.tga", kDown, measured, true, true},
        {"normal/brick_512.jpg", kDown, measured, true, true},
        {"normal/aluminium_745.png", kUp, measured, true, false},
        {"normal/flat_constant_1024.png", std::nullopt, measured, false, true},
        {"normal/detail_bluenoise_512.png", kDown, measured, true, true},
        {"normal/detail_water_512.png", kUp, measured, true, true},
        {"normal/detail_pmndrs_0008.jpg", kUp, measured, true, false},
        {"dds/torque_TP_Ryder_DXT5nm_256_mips9_nvtt.dds", kUp, measured, true, false},
        {"dds/torque_Grenade2_DXT5nm_GGGR_512_mips10.dds", kUp, measured, true, false},
        {"dds/torque_rock_DXT5nm_GGGR_256_mips9.dds", kDown, measured, false, false},
        {"dds/urho_Stone_DXT5_xGxR_1024_mips11.dds", kUp, measured, true, true},
        {"dds/fieldstone_ATI2_512_mips10.dds", kDown, measured, true, true},
        {"dds/amd_RedLetters_1k_normal_ATI2_A2XY.dds", kUp, measured, true, false},
        {"dds/amd_wood_ATI2_A2XY_512_mips10.dds", kUp, measured, true, false},
        {"dds/d3d_RifleStock_DXT1_747x600_mips10_nvtt.dds", kDown, measured, true, false},
        {"dds/d3d_dwarf_armor_RGBA8_512_mips10.dds", kDown, measured, true, false},
        {"dds/gz_waves_RGB24_256_mips9_gimp.dds", kDown, measured, true, true},
    };
    return maps;
}

bool sets_thresholds(const RealMap& map) {
    static const auto hashes = [] {
        std::vector<std::uint32_t> all;
        for (const RealMap& each : real_maps()) {
            if (each.intact) all.push_back(fnv1a(picture_of(each.path)));
        }
        std::sort(all.begin(), all.end());
        all.erase(std::unique(all.begin(), all.end()), all.end());
        return all;
    }();
    return fnv1a(picture_of(map.path)) < hashes[(hashes.size() + 1) / 2];
}

}  // namespace tex::reference
