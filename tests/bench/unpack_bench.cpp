// SPDX-License-Identifier: Apache-2.0
// Texels per second from a texture of one level to normals, on one thread. UnpackCopy moves as many bytes as the result
// has, 12 for each texel, between planes whose pages have already been touched.

#include <string>
#include <utility>

#include <benchmark/benchmark.h>

#include <tex/pack.h>

#include "bench/verb_bench.h"
#include "unit/fields.h"

namespace {

using bench::count_texels;
using tex::NormalMap;

void UnpackCopy(benchmark::State& state) { bench::copy_maps(state, 0); }
BENCHMARK(UnpackCopy)->ArgName("size")->Arg(512)->Arg(4096);

void Unpack(benchmark::State& state) {
    tex::PackOptions options;
    options.encoding = static_cast<tex::Encoding>(state.range(0));
    options.effort = tex::Effort::fast;
    const int size = static_cast<int>(state.range(1));
    tex::MipChain chain;
    chain.levels.push_back(tex::fields::noise_normals({size, size}));
    const tex::Texture texture = std::move(tex::pack(chain, options).value());
    state.SetLabel(std::string(name_of(tex::kEncodingNames, options.encoding)));
    for (auto _ : state) benchmark::DoNotOptimize(tex::unpack(texture, {}, {1, {}}));
    count_texels(state, {size, size});
}
BENCHMARK(Unpack)->ArgNames({"encoding", "size"})->ArgsProduct({benchmark::CreateDenseRange(0, 10, 1), {512, 4096}});

}  // namespace
