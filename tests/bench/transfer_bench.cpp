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

#include <tex/transfer.h>

#include "bench/wavy_sphere.h"
#include "rays/box_tree.h"

namespace {

using tex::bench::rays_at;
using tex::bench::wavy_sphere;

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
