// SPDX-License-Identifier: Apache-2.0
// Texels compared per second, on one thread. CompareCopy reads as many bytes, 24 for each texel, and writes 4. See keep_memory.cpp.

#include <cstring>

#include <benchmark/benchmark.h>

#include <tex/compare.h>

#include "kernels/angle.h"
#include "unit/fields.h"

namespace {

using tex::Extent;
using tex::NormalMap;
using tex::Plane;

// Two maps of noise.
struct Pair {
    explicit Pair(int size) : a(tex::fields::noise_normals({size, size})), b(tex::fields::noise_normals({size, size})), degrees(Extent{size, size}) {
        // The second one is the first, a row further: other normals, of the same kind.
        for (Plane<float>* plane : {&b.x, &b.y, &b.z}) {
            for (int j = 0; j + 1 < size; ++j) std::memcpy(plane->row(j), plane->row(j + 1), static_cast<std::size_t>(size) * sizeof(float));
        }
    }
    NormalMap a, b;
    Plane<float> degrees;
};

void count(benchmark::State& state, int size) {
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(size) * size);
}

void CompareCopy(benchmark::State& state) {
    const int size = static_cast<int>(state.range(0));
    Pair pair(size);
    for (auto _ : state) {
        for (int j = 0; j < size; ++j) {
            for (const NormalMap* map : {&pair.a, &pair.b}) {
                for (const Plane<float>* plane : {&map->x, &map->y, &map->z}) {
                    std::memcpy(pair.degrees.row(j), plane->row(j), static_cast<std::size_t>(size) * sizeof(float));
                }
            }
        }
        benchmark::ClobberMemory();
    }
    count(state, size);
}
BENCHMARK(CompareCopy)->Arg(512)->Arg(4096);

// The kernel alone: angles in degrees.
void CompareRows(benchmark::State& state) {
    const int size = static_cast<int>(state.range(0));
    Pair pair(size);
    for (auto _ : state) {
        for (int j = 0; j < size; ++j) {
            tex::angle_row({pair.a.x.row(j), pair.a.y.row(j), pair.a.z.row(j)}, {pair.b.x.row(j), pair.b.y.row(j), pair.b.z.row(j)}, size,
                           pair.degrees.row(j));
        }
        benchmark::ClobberMemory();
    }
    count(state, size);
}
BENCHMARK(CompareRows)->Arg(512)->Arg(4096);

// With the means, the largest and the exact percentiles.
void Compare(benchmark::State& state) {
    const int size = static_cast<int>(state.range(0));
    const Pair pair(size);
    for (auto _ : state) {
        auto comparison = tex::compare(pair.a, pair.b, {1, {}});
        benchmark::DoNotOptimize(comparison);
    }
    count(state, size);
}
BENCHMARK(Compare)->Arg(512)->Arg(4096);

}  // namespace
