// SPDX-License-Identifier: Apache-2.0
// Texels per second from heights to normals, on one thread. BakeCopy moves as many bytes as bake() does, 4
// read and 12 written for each texel.

#include <string>

#include <benchmark/benchmark.h>

#include <tex/bake.h>

#include "bench/verb_bench.h"
#include "kernels/bake.h"
#include "unit/fields.h"

namespace {

using bench::copy_row;
using bench::count_texels;
using tex::Extent;
using tex::GradientKernel;
using tex::NormalMap;

tex::HeightField noise_field(int size) {
    return tex::fields::field_of({size, size}, 8.0f, tex::Wrap::repeat,
                                 [](int i, int j) { return tex::fields::noise(i, j); });
}

void BakeCopy(benchmark::State& state) {
    const int size = static_cast<int>(state.range(0));
    const tex::HeightField field = noise_field(size);
    NormalMap map(Extent{size, size});
    for (auto _ : state) {
        for (int j = 0; j < size; ++j) {
            for (tex::Plane<float>* plane : {&map.x, &map.y, &map.z}) copy_row(field.height, j, *plane, j);
        }
        benchmark::ClobberMemory();
    }
    count_texels(state, {size, size});
}
BENCHMARK(BakeCopy)->ArgName("size")->Arg(512)->Arg(4096);

// The kernel of central differences alone: it reads rows of the field and writes rows of an existing map.
void BakeRows(benchmark::State& state) {
    const int size = static_cast<int>(state.range(0));
    const tex::HeightField field = noise_field(size);
    NormalMap map(Extent{size, size});
    for (auto _ : state) {
        for (int j = 1; j < size - 1; ++j) {
            const float* row = field.height.row(j);
            tex::normals_by_difference(row - 1, row + 1, field.height.row(j + 1), field.height.row(j - 1), 4.0f, 4.0f,
                                       size, {map.x.row(j), map.y.row(j), map.z.row(j)});
        }
        benchmark::ClobberMemory();
    }
    count_texels(state, {size, size});
}
BENCHMARK(BakeRows)->ArgName("size")->Arg(512)->Arg(4096);

void Bake(benchmark::State& state) {
    const auto kernel = static_cast<GradientKernel>(state.range(0));
    const int size = static_cast<int>(state.range(1));
    const tex::HeightField field = noise_field(size);
    state.SetLabel(std::string(name_of(tex::kGradientKernelNames, kernel)));
    for (auto _ : state) {
        auto map = tex::bake(field, {kernel, 1.0f}, {1, {}});
        benchmark::DoNotOptimize(map.value().x.row(0));
    }
    count_texels(state, {size, size});
}
BENCHMARK(Bake)->ArgNames({"kernel", "size"})->ArgsProduct({{0, 1, 2, 3, 4, 5, 6}, {512, 4096}});

}  // namespace
