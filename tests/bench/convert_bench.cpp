// SPDX-License-Identifier: Apache-2.0
// Measures the conversion of a map on a wavy sheet: milliseconds, the median of five runs.
//
//     convert_bench [TRIANGLES [SIDE]]        default 1,000,000 triangles, a map of 4096x4096

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <vector>

#include <tex/mesh.h>

#include "unit/meshes.h"

namespace {

// The median time of five calls, or -1 if one fails.
double median_ms(const std::function<bool()>& call) {
    std::vector<double> runs;
    for (int k = 0; k < 5; ++k) {
        const auto start = std::chrono::steady_clock::now();
        if (!call()) return -1.0;
        runs.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
    }
    std::sort(runs.begin(), runs.end());
    return runs[2];
}

}  // namespace

int main(int argc, char** argv) {
    const double triangles = argc > 1 ? std::atof(argv[1]) : 1e6;
    const int side = argc > 2 ? std::atoi(argv[2]) : 4096;
    tex::MeshPart part = tex::wavy_part(static_cast<int>(std::sqrt(triangles / 2.0)));
    // Two thirds of the map, so that there is something to pad.
    for (tex::Float2& uv : part.uvs[0]) uv = {0.1f + 0.8f * uv.x, 0.05f + 0.8f * uv.y};
    const auto tangents = tex::make_tangents(part);
    if (!tangents) return 1;
    tex::NormalMap map;
    map.x = tex::Plane<float>({side, side}, 0.36f);
    map.y = tex::Plane<float>({side, side}, 0.48f);
    map.z = tex::Plane<float>({side, side}, 0.8f);
    std::printf("%zu triangles, a map of %dx%d\n\n| what | threads | ms |\n|---|---|---|\n", part.triangles(), side,
                side);
    for (const int threads : {1, 2}) {
        const tex::Execution execution{threads, {}};
        const tex::TangentSpace gltf{part, *tangents}, godot{part, *tangents, 0, tex::Decoder::godot};
        const auto row = [&](const char* what, const std::function<bool()>& call) {
            std::printf("| %s | %d | %.0f |\n", what, threads, median_ms(call));
        };
        row("tangents", [&] { return tex::make_tangents(part, {}, 0, execution).has_value(); });
        row("to object space", [&] { return tex::to_object_space(map, gltf, {}, execution).has_value(); });
        row("to tangent space", [&] { return tex::to_tangent_space(map, gltf, {}, execution).has_value(); });
        row("refit", [&] { return tex::refit(map, gltf, godot, {}, execution).has_value(); });
    }
}
