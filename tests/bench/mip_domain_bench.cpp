// SPDX-License-Identifier: Apache-2.0
// mip_domain_bench: the errors of the levels in either mip domain. For each level of a pattern of waves, it prints the
// angles in degrees between the normals that build_mip_chain() makes and the reference, which is the supersampled
// average of the slopes over the area of a texel.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <utility>
#include <vector>

#include <tex/mip.h>

#include "reference/grid.h"

namespace {

using tex::Extent;
using tex::MipDomain;
using tex::NormalMap;
using tex::reference::Grid;
using tex::reference::Vector;

constexpr int kWaveSize = 256;
constexpr int kSamples = 8;  // of the reference, along a side of a texel of the base level

// The slope of three crossing waves 11 to 37 texels long, less than 60 degrees steep. x runs to the right and y up,
// both from 0 to 1.
Vector wave_slope(double x, double y) {
    struct Wave {
        int across, along;  // crests over the map; whole numbers, so it tiles
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

// The reference normals of a level's texels, from slopes averaged over each texel.
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

}  // namespace

int main() {
    const WaveErrors errors = wave_errors();
    std::printf("| level | vector, mean | slope, mean | vector, largest | slope, largest |\n|---|---|---|---|---|\n");
    for (std::size_t level = 0; level < errors[0].size(); ++level) {
        std::printf("| %zu | %.3f | %.3f | %.3f | %.3f |\n", level, errors[0][level].mean, errors[1][level].mean,
                    errors[0][level].largest, errors[1][level].largest);
    }
}
