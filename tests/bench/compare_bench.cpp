// SPDX-License-Identifier: Apache-2.0
// Texels compared per second, on one thread. CompareCopy reads as many bytes, 24 for each texel, and writes 4.

#include <benchmark/benchmark.h>

#include <tex/check.h>

#include "bench/verb_bench.h"
#include "kernels/angle.h"
#include "unit/fields.h"

namespace {

using bench::copy_row;
using bench::count_texels;
using tex::Extent;
using tex::NormalMap;
using tex::Plane;

// Two maps of noise.
struct Pair {
    explicit Pair(int size)
        : a(tex::fields::noise_normals({size, size})), b(tex::fields::noise_normals({size, size})),
          degrees(Extent{size, size}) {
        // The second map is the first one, shifted by a row: different normals with the same statistics.
        for (Plane<float>* plane : {&b.x, &b.y, &b.z}) {
            for (int j = 0; j + 1 < size; ++j) copy_row(*plane, j + 1, *plane, j);
        }
    }
    NormalMap a, b;
    Plane<float> degrees;
};

void CompareCopy(benchmark::State& state) {
    const int size = static_cast<int>(state.range(0));
    Pair pair(size);
    for (auto _ : state) {
        for (int j = 0; j < size; ++j) {
            for (const NormalMap* map : {&pair.a, &pair.b}) {
                for (const Plane<float>* plane : {&map->x, &map->y, &map->z}) copy_row(*plane, j, pair.degrees, j);
            }
        }
        benchmark::ClobberMemory();
    }
    count_texels(state, {size, size});
}
BENCHMARK(CompareCopy)->ArgName("size")->Arg(512)->Arg(4096);

// The kernel alone: angles in degrees.
void CompareRows(benchmark::State& state) {
    const int size = static_cast<int>(state.range(0));
    Pair pair(size);
    for (auto _ : state) {
        for (int j = 0; j < size; ++j) {
            tex::angle_row({pair.a.x.row(j), pair.a.y.row(j), pair.a.z.row(j)},
                           {pair.b.x.row(j), pair.b.y.row(j), pair.b.z.row(j)}, size, pair.degrees.row(j));
        }
        benchmark::ClobberMemory();
    }
    count_texels(state, {size, size});
}
BENCHMARK(CompareRows)->ArgName("size")->Arg(512)->Arg(4096);

// With the means, the largest angle and the exact percentiles.
void Compare(benchmark::State& state) {
    const int size = static_cast<int>(state.range(0));
    const Pair pair(size);
    for (auto _ : state) {
        auto comparison = tex::compare(pair.a, pair.b, {1, {}});
        benchmark::DoNotOptimize(comparison);
    }
    count_texels(state, {size, size});
}
BENCHMARK(Compare)->ArgName("size")->Arg(512)->Arg(4096);

}  // namespace
