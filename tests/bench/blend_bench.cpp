// SPDX-License-Identifier: Apache-2.0
// Texels per second of a detail on a base of the same extent, on one thread: the kernel over strips that stay in the
// cache (BlendRows), and the verb on whole maps (Blend). BlendCopy moves nearly as many bytes: 8 floats for each texel,
// where blending reads 6 and writes 3.

#include <string>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>

#include <tex/blend.h>

#include "bench/verb_bench.h"
#include "kernels/blend.h"
#include "unit/fields.h"
#include "unit/normal_maps.h"

namespace {

using bench::count_texels;
using tex::BlendMode;
using tex::NormalMap;

void BlendCopy(benchmark::State& state) { bench::copy_maps(state, 1); }
BENCHMARK(BlendCopy)->ArgName("size")->Arg(512)->Arg(2048);

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
            tex::blend_row(mode, {base.x.row(j), base.y.row(j), base.z.row(j)},
                           {detail.x.row(j), detail.y.row(j), detail.z.row(j)}, nullptr, kWidth);
        }
        benchmark::ClobberMemory();
    }
    count_texels(state, {kWidth, kHeight});
}
BENCHMARK(BlendRows)->ArgName("mode")->DenseRange(0, 5);

// Measures only the work of blend(), which consumes its maps.
void blend_again(benchmark::State& state, int size, const tex::BlendOptions& options, float tiling, float degrees) {
    const NormalMap base = tex::fields::noise_normals({size, size});
    const NormalMap detail = tex::wavy_map({size, size});
    for (auto _ : state) {
        state.PauseTiming();
        std::vector<tex::Layer> layers(1);
        layers.front().detail = tex::chain_from(tex::copy_of(detail));
        layers.front().tiling_x = layers.front().tiling_y = tiling;
        layers.front().rotation = degrees;
        tex::MipChain chain = tex::chain_from(tex::copy_of(base));
        state.ResumeTiming();
        benchmark::DoNotOptimize(tex::blend(std::move(chain), std::move(layers), options, {1, {}}));
    }
    count_texels(state, {size, size});
}

void Blend(benchmark::State& state) {
    tex::BlendOptions options;
    options.mode = static_cast<BlendMode>(state.range(0));
    state.SetLabel(std::string(name_of(tex::kBlendModeNames, options.mode)));
    blend_again(state, static_cast<int>(state.range(1)), options, 1.0f, 0.0f);
}
BENCHMARK(Blend)->ArgNames({"mode", "size"})->ArgsProduct({{0, 1, 2, 3, 4, 5}, {512, 2048}});

// Whiteout of a detail that is repeated or rotated: its levels are built, and two of them are sampled if neither fits.
void BlendPlaced(benchmark::State& state) {
    const float tiling = static_cast<float>(state.range(0)) / 10.0f;
    const auto degrees = static_cast<float>(state.range(1));
    state.SetLabel(std::to_string(tiling).substr(0, 3) + " times" + (degrees == 0.0f ? "" : ", turned"));
    blend_again(state, static_cast<int>(state.range(2)), {}, tiling, degrees);
}
BENCHMARK(BlendPlaced)
    ->ArgNames({"tenths", "degrees", "size"})
    ->ArgsProduct({{40, 15}, {0}, {512, 2048}})
    ->ArgsProduct({{10}, {30}, {512, 2048}});

}  // namespace
