// SPDX-License-Identifier: Apache-2.0
// Texels per second of a detail on a base of the same extent, on one thread: the kernel over strips that stay in the cache (BlendRows), and the verb
// on whole maps (Blend). BlendCopy moves nearly as many bytes: 8 floats for each texel, where blending reads 6 and writes 3. See keep_memory.cpp.

#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>

#include <tex/blend.h>

#include "kernels/blend.h"
#include "unit/fields.h"
#include "unit/normal_maps.h"

namespace {

using tex::BlendMode;
using tex::Extent;
using tex::NormalMap;

void count(benchmark::State& state, int size) {
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(size) * size);
}

void BlendCopy(benchmark::State& state) {
    const int size = static_cast<int>(state.range(0));
    const NormalMap from = tex::fields::noise_normals({size, size});
    NormalMap to = tex::fields::noise_normals({size, size});
    const std::size_t bytes = static_cast<std::size_t>(size) * sizeof(float);
    for (auto _ : state) {
        for (int j = 0; j < size; ++j) {
            std::memcpy(to.x.row(j), from.x.row(j), bytes);
            std::memcpy(to.y.row(j), from.y.row(j), bytes);
            std::memcpy(to.z.row(j), from.z.row(j), bytes);
            std::memcpy(to.x.row(j), from.y.row(j), bytes);
        }
        benchmark::ClobberMemory();
    }
    count(state, size);
}
BENCHMARK(BlendCopy)->Arg(512)->Arg(4096);

// In place, on rows that stay in the cache.
void BlendRows(benchmark::State& state) {
    const auto mode = static_cast<BlendMode>(state.range(0));
    constexpr int kWidth = 1024;
    constexpr int kHeight = 32;
    NormalMap base = tex::fields::noise_normals({kWidth, kHeight});
    NormalMap detail = tex::wavy_map({kWidth, kHeight});
    state.SetLabel(std::string(name_of(tex::kBlendModeNames, mode)));
    for (auto _ : state) {
        for (int j = 0; j < kHeight; ++j) {
            tex::blend_row(mode, {base.x.row(j), base.y.row(j), base.z.row(j)}, {detail.x.row(j), detail.y.row(j), detail.z.row(j)},
                           nullptr, kWidth);
        }
        benchmark::ClobberMemory();
    }
    state.SetItemsProcessed(state.iterations() * std::int64_t{kWidth} * kHeight);
}
BENCHMARK(BlendRows)->DenseRange(0, 5);

void Blend(benchmark::State& state) {
    tex::BlendOptions options;
    options.mode = static_cast<BlendMode>(state.range(0));
    const int size = static_cast<int>(state.range(1));
    const NormalMap base = tex::fields::noise_normals({size, size});
    const NormalMap detail = tex::wavy_map({size, size});
    state.SetLabel(std::string(name_of(tex::kBlendModeNames, options.mode)));
    for (auto _ : state) {
        state.PauseTiming();  // blend() takes its maps
        std::vector<tex::Layer> layers(1);
        layers.front().detail = tex::chain_from(tex::copy_of(detail));
        tex::MipChain chain = tex::chain_from(tex::copy_of(base));
        state.ResumeTiming();
        benchmark::DoNotOptimize(tex::blend(std::move(chain), std::move(layers), options, {1, {}}));
    }
    count(state, size);
}
BENCHMARK(Blend)->ArgsProduct({{0, 1, 2, 3, 4, 5}, {512, 2048}});

}  // namespace
