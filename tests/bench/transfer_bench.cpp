// SPDX-License-Identifier: Apache-2.0
// Measures the tree of boxes, its rays, and transfer() from a sphere with waves to a coarse one: the medians of three
// runs, of wall time and of the time of all processors.
//
//     transfer_bench [TRIANGLES [SIZE]]        default 998,000 triangles, a map of 2048x2048

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <utility>
#include <vector>

#include <tex/tangents.h>
#include <tex/transfer.h>

#include "rays/box_tree.h"

namespace {

tex::MeshPart wavy_sphere(int columns, int rows, float waves) {
    tex::MeshPart part;
    part.uvs.resize(1);
    for (int j = 0; j <= rows; ++j) {
        for (int i = 0; i <= columns; ++i) {
            const float u = static_cast<float>(i) / static_cast<float>(columns),
                        v = static_cast<float>(j) / static_cast<float>(rows);
            const float a = 6.2831853f * u, b = 3.1415927f * (v - 0.5f);
            const tex::Float3 n{std::cos(a) * std::cos(b), std::sin(b), -std::sin(a) * std::cos(b)};
            const float r = 1.0f + waves * std::sin(40.0f * a) * std::sin(40.0f * b);
            part.positions.push_back({r * n.x, r * n.y, r * n.z});
            part.normals.push_back(n);
            part.uvs[0].push_back({u, v});
        }
    }
    for (int j = 0; j < rows; ++j) {
        for (int i = 0; i < columns; ++i) {
            const auto a = static_cast<std::uint32_t>(j * (columns + 1) + i),
                       c = a + static_cast<std::uint32_t>(columns) + 1;
            for (const std::uint32_t k : {a, a + 1, c + 1, a, c + 1, c}) part.indices.push_back(k);
        }
    }
    return part;
}

struct Took {
    double wall = 0.0, processor = 0.0;  // seconds
};

constexpr std::size_t kRuns = 3;

Took median_of(const std::function<void()>& body) {
    std::vector<Took> runs;
    while (runs.size() < kRuns) {
        const auto start = std::chrono::steady_clock::now();
        const std::clock_t before = std::clock();
        body();
        runs.push_back({std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(),
                        static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC});
    }
    std::sort(runs.begin(), runs.end(), [](const Took& a, const Took& b) { return a.wall < b.wall; });
    return runs[kRuns / 2];
}

// A ray for each texel, as transfer() casts them.
std::vector<tex::Ray> rays_at(int size, double reach) {
    std::vector<tex::Ray> rays;
    for (int j = 0; j < size; ++j) {
        for (int i = 0; i < size; ++i) {
            const double a = 6.283185307 * (i + 0.5) / size, b = 3.141592654 * ((j + 0.5) / size - 0.5);
            const double n[3] = {std::cos(a) * std::cos(b), std::sin(b), -std::sin(a) * std::cos(b)};
            const double far = 1.0 + reach;
            rays.push_back(
                {{far * n[0], far * n[1], far * n[2]}, {-n[0], -n[1], -n[2]}, 2.0 * reach, tex::Facing::front});
        }
    }
    return rays;
}

}  // namespace

int main(int argc, char** argv) {
    const double triangles = argc > 1 ? std::atof(argv[1]) : 998000.0;
    const int size = argc > 2 ? std::atoi(argv[2]) : 2048;
    const int rows = static_cast<int>(std::sqrt(triangles / 4.0));
    const std::vector<tex::MeshPart> high = {wavy_sphere(2 * rows, rows, 0.01f)};
    const tex::MeshPart low = wavy_sphere(140, 69, 0.0f);
    const auto tangents = tex::make_tangents(low);
    if (!tangents) return 1;
    std::printf("%zu triangles onto %zu, %dx%d\n\n| what | threads | seconds | of processors |\n|---|---|---|---|\n",
                high[0].triangles(), low.triangles(), size, size);
    const auto print = [](const char* what, int threads, const Took& took) {
        std::printf("| %s | %d | %.2f | %.2f |\n", what, threads, took.wall, took.processor);
        std::fflush(stdout);
    };
    const tex::Triangles all({&high[0]});
    for (const int threads : {1, 2})
        print("the tree", threads, median_of([&] { (void)tex::BoxTree::build(all, {threads, {}}).has_value(); }));
    const auto tree = tex::BoxTree::build(all, {});
    if (!tree) return 1;
    const std::vector<tex::Ray> rays = rays_at(size, 0.02);
    std::vector<tex::RayHit> hits(rays.size());
    const Took traced = median_of([&] { tex::trace_rays(tree->view(), rays.data(), rays.size(), hits.data()); });
    print("rays alone", 1, traced);
    for (const auto& [subsamples, threads] : {std::pair{1, 1}, {1, 2}, {4, 2}}) {
        tex::TransferOptions options;
        options.heights = true;
        options.subsamples = subsamples;
        const tex::Execution execution{threads, {}};
        const Took took = median_of([&] {
            if (!tex::transfer({size, size}, {low, *tangents}, high, options, execution)) std::exit(1);
        });
        print(subsamples == 1 ? "transfer()" : "transfer(), 4x4 subsamples", threads, took);
    }
    for (const bool inwards : {false, true}) {
        tex::TransferOptions options;
        (inwards ? options.thickness : options.occlusion) = true;
        const int quarter = std::max(1, size / 4);
        std::int64_t rays_cast = 0;
        const Took took = median_of([&] {
            const auto maps = tex::transfer({quarter, quarter}, {low, *tangents}, high, options, {1, {}});
            if (!maps) std::exit(1);
            rays_cast = maps->rays;
        });
        print(inwards ? "thickness, 64 rays a hit" : "occlusion, 64 rays a hit", 1, took);
        std::printf("%.2f million rays a second of processor time, %d x %d\n",
                    static_cast<double>(rays_cast) / took.processor / 1e6, quarter, quarter);
    }
    std::printf("\n%.2f million rays a second on one thread\n", static_cast<double>(rays.size()) / traced.wall / 1e6);
}
