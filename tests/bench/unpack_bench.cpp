// SPDX-License-Identifier: Apache-2.0
// Texels per second from a texture of one level to normals, on one thread. UnpackCopy moves as many bytes as the result has, 12 for each texel,
// between planes that were touched before. See keep_memory.cpp.

#include <cstring>
#include <string>
#include <utility>

#include <benchmark/benchmark.h>

#include <tex/pack.h>
#include <tex/unpack.h>

#include "unit/fields.h"

namespace {

using tex::Extent;
using tex::NormalMap;

void count(benchmark::State& state, int size) {
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(size) * size);
}

void UnpackCopy(benchmark::State& state) {
    const int size = static_cast<int>(state.range(0));
    const NormalMap from = tex::fields::noise_normals({size, size});
    NormalMap to = tex::fields::noise_normals({size, size});
    for (auto _ : state) {
        for (int j = 0; j < size; ++j) {
            std::memcpy(to.x.row(j), from.x.row(j), static_cast<std::size_t>(size) * sizeof(float));
            std::memcpy(to.y.row(j), from.y.row(j), static_cast<std::size_t>(size) * sizeof(float));
            std::memcpy(to.z.row(j), from.z.row(j), static_cast<std::size_t>(size) * sizeof(float));
        }
        benchmark::ClobberMemory();
    }
    count(state, size);
}
BENCHMARK(UnpackCopy)->Arg(512)->Arg(4096);

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
    count(state, size);
}
BENCHMARK(Unpack)->ArgsProduct({benchmark::CreateDenseRange(0, 10, 1), {512, 4096}});

}  // namespace
