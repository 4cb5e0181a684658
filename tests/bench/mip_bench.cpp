// SPDX-License-Identifier: Apache-2.0
// Texels of the base level per second for building a complete chain, on one thread. MipCopy moves as many bytes: it
// reads the base level, 12 bytes for each texel, and writes a third as many.

#include <string>
#include <utility>

#include <benchmark/benchmark.h>

#include <tex/mip.h>

#include "bench/verb_bench.h"
#include "kernels/mip.h"
#include "unit/fields.h"

namespace {

using bench::copy_row;
using bench::count_texels;
using tex::Extent;
using tex::MipDomain;
using tex::MipFilter;
using tex::NormalMap;

void MipCopy(benchmark::State& state) {
    const int size = static_cast<int>(state.range(0));
    const NormalMap base = tex::fields::noise_normals({size, size});
    NormalMap third(Extent{size, size / 3});
    for (auto _ : state) {
        for (int j = 0; j < size / 3 * 3; ++j) {
            copy_row(base.x, j, third.x, j / 3);
            copy_row(base.y, j, third.y, j / 3);
            copy_row(base.z, j, third.z, j / 3);
        }
        benchmark::ClobberMemory();
    }
    count_texels(state, {size, size});
}
BENCHMARK(MipCopy)->ArgName("size")->Arg(512)->Arg(4095)->Arg(4096);

// The kernel of the box filter alone, for one level.
void MipRows(benchmark::State& state) {
    const int size = static_cast<int>(state.range(0));
    const NormalMap base = tex::fields::noise_normals({size, size});
    NormalMap half(Extent{size / 2, size / 2});
    for (auto _ : state) {
        for (int j = 0; j < size / 2; ++j) {
            tex::halve_rows(base.x.row(2 * j), base.x.row(2 * j + 1), size / 2, half.x.row(j));
            tex::halve_rows(base.y.row(2 * j), base.y.row(2 * j + 1), size / 2, half.y.row(j));
            tex::halve_rows(base.z.row(2 * j), base.z.row(2 * j + 1), size / 2, half.z.row(j));
        }
        benchmark::ClobberMemory();
    }
    count_texels(state, {size, size});
}
BENCHMARK(MipRows)->ArgName("size")->Arg(512)->Arg(4096);

void Mip(benchmark::State& state) {
    tex::MipOptions options;
    options.filter = static_cast<MipFilter>(state.range(0));
    options.domain = static_cast<MipDomain>(state.range(1));
    const int size = static_cast<int>(state.range(2));
    NormalMap base = tex::fields::noise_normals({size, size});
    state.SetLabel(std::string(name_of(tex::kMipFilterNames, options.filter)) + " " +
                   std::string(name_of(tex::kMipDomainNames, options.domain)));
    for (auto _ : state) {
        auto chain = tex::build_mip_chain(std::move(base), options, {1, {}});
        base = std::move(chain.value().levels[0]);
    }
    count_texels(state, {size, size});
}
BENCHMARK(Mip)->ArgNames({"filter", "domain", "size"})->ArgsProduct({{0, 1, 2, 3, 4, 5}, {0, 1}, {512, 4095, 4096}});

}  // namespace
