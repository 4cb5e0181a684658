// SPDX-License-Identifier: Apache-2.0
// integrate_bench: heights from normals: seconds and memory at 4096x4096, and, on the pairs of ../shared/data, how
// close the heights come to those that their authors published.

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <tex/bake.h>
#include <tex/file.h>
#include <tex/surface.h>

#include "unit/fields.h"

namespace {

using namespace tex;

double seconds_of(const NormalMap& map, const IntegrateOptions& options) {
    constexpr int kRuns = 3;
    double best = 1e9;
    for (int run = 0; run < kRuns; ++run) {
        const auto begin = std::chrono::steady_clock::now();
        const auto result = integrate(map, options, {2, {}});
        if (!result) return -1.0;
        best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
    }
    return best;
}

void print_times() {
    std::printf("| extent | kernel | wrap | s, best of three | peak, MB |\n|---|---|---|---|---|\n");
    for (const int size : {1024, 4096, 4099}) {
        for (const GradientKernel kernel : {GradientKernel::central, GradientKernel::sobel}) {
            for (const auto& wrap : kWrapNames) {
                if (kernel == GradientKernel::sobel && (wrap.value == Wrap::mirror || size != 4096)) continue;
                HeightField field = fields::field_of({size, size}, 8.0f, wrap.value, [](int i, int j) {
                    return std::sin(0.01 * i + 0.003 * j) + 0.05 * fields::noise(i, j);
                });
                const NormalMap map = std::move(bake(field, {kernel, 1.0f}).value());
                field = {};
                IntegrateOptions options;
                options.bake.kernel = kernel;
                options.bumpiness_x = options.bumpiness_y = 8.0f;
                options.wrap_x = options.wrap_y = wrap.value;
                const double seconds = seconds_of(map, options);
                rusage usage{};
                getrusage(RUSAGE_SELF, &usage);
                std::printf("| %dx%d | %s | %s | %.2f | %ld |\n", size, size,
                            std::string(name_of(kGradientKernelNames, kernel)).c_str(), std::string(wrap.name).c_str(),
                            seconds, usage.ru_maxrss / 1024);
            }
        }
    }
}

struct Pair {
    const char* name;
    const char* normals;
    const char* heights;
    HeightChannel channel;
    YAxis y;
    GradientKernel kernel;  // as measured by SOURCES.md
};

constexpr Pair kPairs[] = {
    {"d3d_pom_rocks", "normal_rgb_height_a.tga", "normal_rgb_height_a.tga", HeightChannel::a, YAxis::up,
     GradientKernel::sobel},
    {"d3d_pom_bump", "normal_rgb_height_a.tga", "normal_rgb_height_a.tga", HeightChannel::a, YAxis::down,
     GradientKernel::sobel},
    {"oiio_bump", "normal_YDOWN_half.exr", "height_half.exr", HeightChannel::automatic, YAxis::down,
     GradientKernel::central},
    {"godot_cheese", "normal_GL.png", "height_INVERTED.png", HeightChannel::automatic, YAxis::up,
     GradientKernel::sobel},
    {"Tiles036", "normal_DX.jpg", "height.jpg", HeightChannel::automatic, YAxis::down, GradientKernel::central},
    {"Bricks102", "normal_DX.jpg", "height.jpg", HeightChannel::automatic, YAxis::down, GradientKernel::central},
    {"bevy_cube", "normal_GL.png", "height_INVERTED.png", HeightChannel::automatic, YAxis::up, GradientKernel::central},
};

struct Fit {
    double slope = 0.0;  // texels for the published height 1.0
    double correlation = 0.0;
    double rms = 0.0;  // of what remains, in published heights
};

// The line that makes the published heights from ours.
Fit fit_of(const Plane<float>& ours, const Plane<float>& theirs) {
    const Extent extent = ours.extent();
    const auto count = static_cast<double>(extent.texels());
    double a = 0.0, b = 0.0, aa = 0.0, bb = 0.0, ab = 0.0;
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            const auto x = static_cast<double>(ours.at(i, j)), y = static_cast<double>(theirs.at(i, j));
            a += x;
            b += y;
            aa += x * x;
            bb += y * y;
            ab += x * y;
        }
    }
    const double xx = aa - a * a / count, yy = bb - b * b / count, xy = ab - a * b / count;
    return {xx / xy, xy / std::sqrt(xx * yy), std::sqrt(std::max(0.0, (yy - xy * xy / xx) / count))};
}

void print_pairs() {
    const std::filesystem::path folder = TEX_SOURCE_DIR "/../shared/data/pairs";
    if (!std::filesystem::exists(folder)) return;
    std::printf(
        "\n| pair | kernel | wrap | correlation | error, %% of the range | strength, texels | curl: mean | p99 | "
        "max |\n|---|---|---|---|---|---|---|---|---|\n");
    for (const Pair& pair : kPairs) {
        SourceOptions reading;
        reading.unpack.y_axis = pair.y;
        const auto source = read_normals((folder / pair.name / pair.normals).string(), reading, true);
        const auto image = read_image((folder / pair.name / pair.heights).string());
        if (!source || !image) continue;
        HeightOptions channel;
        channel.channel = pair.channel;
        const auto heights = height_field(*image, channel);
        for (const Wrap wrap : {Wrap::repeat, Wrap::clamp}) {
            IntegrateOptions options;
            options.bake.kernel = pair.kernel;
            options.wrap_x = options.wrap_y = wrap;
            if (source->info.format != Format::rgb16_float && source->info.format != Format::rgba16_float) {
                options.least_z = 0x1p-7f;
                options.least_response = 0.1f;
            }
            const auto result = integrate(source->chain.levels.front(), options);
            if (!result) continue;
            const Fit fit = fit_of(result->field.height, heights->height);
            std::printf("| %s | %s | %s | %.4f | %.2f | %.2f | %.2f | %.2f | %.1f |\n", pair.name,
                        std::string(name_of(kGradientKernelNames, pair.kernel)).c_str(),
                        std::string(name_of(kWrapNames, wrap)).c_str(), std::abs(fit.correlation), 100.0 * fit.rms,
                        fit.slope, result->curl.mean, result->curl.p99, result->curl.max);
        }
    }
}

}  // namespace

int main() {
    print_times();
    print_pairs();
}
