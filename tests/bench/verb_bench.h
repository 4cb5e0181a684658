// SPDX-License-Identifier: Apache-2.0
// verb_bench.h: the code that the benchmarks of verbs share. Each program registers its benchmarks with Google
// Benchmark. verb_main.cpp runs them and prints one table. The table has a row for each benchmark and a column for each
// size, and shows texels per second and the ratio to copying at that size. So each program names its argument "size"
// and has a benchmark whose name ends with "Copy", which moves as many bytes between planes whose pages have already
// been touched.

#pragma once

#include <cstdint>
#include <cstring>

#include <benchmark/benchmark.h>

#include <tex/types.h>

#include "unit/fields.h"

namespace bench {

inline void count_texels(benchmark::State& state, tex::Extent extent) {
    state.SetItemsProcessed(state.iterations() * std::int64_t{extent.width} * extent.height);
}

// Copies row `from_row` of one plane to row `to_row` of another of the same width.
inline void copy_row(const tex::Plane<float>& from, int from_row, tex::Plane<float>& to, int to_row) {
    std::memcpy(to.row(to_row), from.row(from_row), static_cast<std::size_t>(from.extent().width) * sizeof(float));
}

// Copies maps: x, y, z, and `more` planes again.
inline void copy_maps(benchmark::State& state, int more) {
    const int size = static_cast<int>(state.range(0));
    const tex::NormalMap from = tex::fields::noise_normals({size, size});
    tex::NormalMap to = tex::fields::noise_normals({size, size});
    for (auto _ : state) {
        for (int j = 0; j < size; ++j) {
            copy_row(from.x, j, to.x, j);
            copy_row(from.y, j, to.y, j);
            copy_row(from.z, j, to.z, j);
            for (int k = 0; k < more; ++k) copy_row(from.y, j, to.x, j);
        }
        benchmark::ClobberMemory();
    }
    count_texels(state, {size, size});
}

}  // namespace bench
