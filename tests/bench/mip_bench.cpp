// SPDX-License-Identifier: Apache-2.0
// Texels of the base level per second to a complete chain, on one thread. MipCopy moves as many bytes: the
// base level is read, 12 bytes for each texel, and a third as many are written. See keep_memory.cpp.
//
// MipWaves times nothing: its counters are the angular errors of each level of a wave pattern against the supersampled truth.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numbers>
#include <vector>

#include <benchmark/benchmark.h>

#include <tex/mip.h>

#include "kernels/mip.h"
#include "reference/grid.h"
#include "unit/fields.h"

namespace {

using tex::Extent;
using tex::MipDomain;
using tex::MipFilter;
using tex::NormalMap;

void count(benchmark::State& state, int size) {
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(size) * size);
}

void MipCopy(benchmark::State& state) {
    const int size = static_cast<int>(state.range(0));
    const NormalMap base = tex::fields::noise_normals({size, size});
    NormalMap third(Extent{size, size / 3});
    for (auto _ : state) {
        for (int j = 0; j < size / 3 * 3; ++j) {
            std::memcpy(third.x.row(j / 3), base.x.row(j), static_cast<std::size_t>(size) * sizeof(float));
            std::memcpy(third.y.row(j / 3), base.y.row(j), static_cast<std::size_t>(size) * sizeof(float));
            std::memcpy(third.z.row(j / 3), base.z.row(j), static_cast<std::size_t>(size) * sizeof(float));
        }
        benchmark::ClobberMemory();
    }
    count(state, size);
}
BENCHMARK(MipCopy)->Arg(512)->Arg(4096);

// The kernel of the box filter alone: one level.
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
    count(state, size);
}
BENCHMARK(MipRows)->Arg(512)->Arg(4096);

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
    count(state, size);
}
BENCHMARK(Mip)->ArgsProduct({{0, 1, 2, 3, 4, 5}, {0, 1}, {512, 4095, 4096}});

// -- what the levels of either domain miss -----------------------------------------------------------------

using tex::reference::Grid;
using tex::reference::Vector;

constexpr int kWaveSize = 256;
constexpr int kSamples = 8;  // of the truth along a side of a texel of the base level

// The slope of three crossing waves 11 to 37 texels long, less than 60 degrees steep. x runs to the right and y up, both from 0 to 1.
Vector wave_slope(double x, double y) {
    struct Wave {
        int across, along;  // crests over the map: it tiles
        double steepness;
    };
    constexpr Wave kWaves[] = {{7, 0, 0.6}, {5, 12, 0.6}, {-19, 14, 0.5}};
    Vector slope;
    for (const Wave& wave : kWaves) {
        const double turn = 2.0 * std::numbers::pi * (wave.across * x + wave.along * y);
        const double length = std::hypot(wave.across, wave.along);
        slope.x += wave.steepness * std::cos(turn) * wave.across / length;
        slope.y += wave.steepness * std::cos(turn) * wave.along / length;
    }
    return slope;
}

// The normals of the heights that a level's texels cover: slopes averaged over the texel.
std::vector<Grid<Vector>> wave_truth() {
    Grid<Vector> slopes(Extent{kWaveSize, kWaveSize});
    for (int j = 0; j < kWaveSize * kSamples; ++j) {
        for (int i = 0; i < kWaveSize * kSamples; ++i) {
            constexpr double kStep = 1.0 / (kWaveSize * kSamples);
            const Vector slope = wave_slope((i + 0.5) * kStep, 1.0 - (j + 0.5) * kStep);
            Vector& mean = slopes.at(i / kSamples, j / kSamples);
            mean.x += slope.x / (kSamples * kSamples);
            mean.y += slope.y / (kSamples * kSamples);
        }
    }
    std::vector<Grid<Vector>> levels;
    while (true) {
        Grid<Vector>& normals = levels.emplace_back(slopes.extent);
        for (std::size_t k = 0; k < normals.values.size(); ++k)
            normals.values[k] = tex::reference::normalised({-slopes.values[k].x, -slopes.values[k].y, 1.0});
        const int half = slopes.extent.width / 2;
        if (half == 0) return levels;
        Grid<Vector> next(Extent{half, half});
        for (int j = 0; j < 2 * half; ++j) {
            for (int i = 0; i < 2 * half; ++i) {
                next.at(i / 2, j / 2).x += slopes.at(i, j).x / 4.0;
                next.at(i / 2, j / 2).y += slopes.at(i, j).y / 4.0;
            }
        }
        slopes = std::move(next);
    }
}

struct WaveError {
    double mean = 0.0, largest = 0.0;  // degrees
};

// [domain][level]
using WaveErrors = std::array<std::vector<WaveError>, 2>;

WaveErrors wave_errors() {
    const auto truth = wave_truth();
    WaveErrors errors;
    for (const MipDomain domain : {MipDomain::vector, MipDomain::slope}) {
        NormalMap base(Extent{kWaveSize, kWaveSize});
        for (int j = 0; j < kWaveSize; ++j) {
            for (int i = 0; i < kWaveSize; ++i) {
                const Vector slope = wave_slope((i + 0.5) / kWaveSize, 1.0 - (j + 0.5) / kWaveSize);
                const Vector n = tex::reference::normalised({-slope.x, -slope.y, 1.0});
                base.x.at(i, j) = static_cast<float>(n.x);
                base.y.at(i, j) = static_cast<float>(n.y);
                base.z.at(i, j) = static_cast<float>(n.z);
            }
        }
        tex::MipOptions options;
        options.domain = domain;
        const auto chain = std::move(tex::build_mip_chain(std::move(base), options).value());
        for (std::size_t level = 0; level < truth.size(); ++level) {
            const Grid<Vector> made = tex::reference::grid_of(chain.levels[level]);
            WaveError& error = errors[domain == MipDomain::slope ? 1 : 0].emplace_back();
            for (std::size_t k = 0; k < made.values.size(); ++k) {
                const double angle = tex::reference::angle_between(made.values[k], truth[level].values[k]);
                error.mean += angle / static_cast<double>(made.values.size());
                error.largest = std::max(error.largest, angle);
            }
        }
    }
    return errors;
}

void MipWaves(benchmark::State& state) {
    static const WaveErrors kErrors = wave_errors();
    const auto level = static_cast<std::size_t>(state.range(0));
    for (auto _ : state) benchmark::DoNotOptimize(level);
    state.counters["vector_mean_degrees"] = kErrors[0][level].mean;
    state.counters["slope_mean_degrees"] = kErrors[1][level].mean;
    state.counters["vector_max_degrees"] = kErrors[0][level].largest;
    state.counters["slope_max_degrees"] = kErrors[1][level].largest;
}
BENCHMARK(MipWaves)->ArgName("level")->DenseRange(0, 8)->Iterations(1);

}  // namespace
