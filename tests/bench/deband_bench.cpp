// SPDX-License-Identifier: Apache-2.0
// deband_bench: heights from 8 bits: the mean angle to the bake of the original on the maps of ../shared/data with more
// bits, beside the best Gaussian blur, and seconds and memory at 4096x4096.

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <tex/bake.h>
#include <tex/check.h>
#include <tex/file.h>
#include <tex/height.h>

#include "unit/fields.h"

namespace {

using namespace tex;

constexpr float kBumpiness = 20.0f;

void print_times() {
    std::printf("| extent | heights | s, best of three | peak, MB |\n|---|---|---|---|\n");
    for (const int size : {1024, 4096}) {
        for (const double rough : {0.0, 0.05}) {
            double best = 1e9;
            for (int run = 0; run < 3; ++run) {
                HeightField field = fields::field_of({size, size}, kBumpiness, Wrap::repeat, [&](int i, int j) {
                    const double hills = 0.5 + 0.4 * std::sin(0.006 * i) * std::cos(0.004 * j);
                    return std::round(255.0 * (hills + rough * fields::noise(i, j))) / 255.0;
                });
                const auto begin = std::chrono::steady_clock::now();
                if (!deband(std::move(field), Deband::on, {2, {}})) return;
                best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
            }
            rusage usage{};
            getrusage(RUSAGE_SELF, &usage);
            std::printf("| %dx%d | %s | %.2f | %ld |\n", size, size, rough > 0.0 ? "rough" : "smooth", best,
                        usage.ru_maxrss / 1024);
        }
    }
}

HeightField with(Plane<float> heights, Wrap wrap) { return {std::move(heights), kBumpiness, kBumpiness, wrap, wrap}; }

// The heights rounded to steps of 1 / `most`.
Plane<float> rounded(const Plane<float>& heights, float most) {
    return fields::plane_of(heights.extent(), [&](int i, int j) {
        return static_cast<double>(std::round(heights.at(i, j) * most) / most);
    });
}

double angle(const NormalMap& truth, const HeightField& field) {
    return compare(bake(field).value(), truth)->error.mean;
}

struct Blur {
    double angle = std::numeric_limits<double>::max();
    float sigma = 0.0f;
};

Blur best_blur(const NormalMap& truth, const Plane<float>& heights, Wrap wrap) {
    Blur best;
    for (const float sigma : {0.0f, 0.35f, 0.4f, 0.5f, 0.6f, 0.8f, 1.0f, 1.5f, 2.0f, 3.0f, 4.0f, 6.0f, 8.0f, 12.0f}) {
        Image image;
        image.planes.push_back(heights.clone());
        image.names = {"Y"};
        HeightOptions options;
        options.blur_sigma = sigma;
        options.wrap_x = options.wrap_y = wrap;
        const double found = angle(truth, with(std::move(height_field(image, options)->height), wrap));
        if (found < best.angle) best = {found, sigma};
    }
    return best;
}

// Whether all texels round to the steps of `in`.
bool rounds_to(const Plane<float>& in, const Plane<float>& out) {
    for (int j = 0; j < in.extent().height; ++j) {
        for (int i = 0; i < in.extent().width; ++i) {
            if (std::round(out.at(i, j) * 255.0f) != std::round(in.at(i, j) * 255.0f)) return false;
        }
    }
    return true;
}

void print_map(const std::string& name, Plane<float> heights, Wrap wrap) {
    float low = heights.at(0, 0), high = low;
    for (int j = 0; j < heights.extent().height; ++j) {
        const float* const row = heights.row(j);
        low = std::min(low, *std::min_element(row, row + heights.extent().width));
        high = std::max(high, *std::max_element(row, row + heights.extent().width));
    }
    if (low < 0.0f || high > 1.0f) {  // metres
        heights = fields::plane_of(heights.extent(), [&](int i, int j) {
            return static_cast<double>((heights.at(i, j) - low) / (high - low));
        });
    }
    const Plane<float> codes = rounded(heights, 255.0f);
    const Plane<float> deep = rounded(heights, 65535.0f);
    const NormalMap truth = bake(with(heights.clone(), wrap)).value();
    const double without = angle(truth, with(codes.clone(), wrap));
    const Blur blur = best_blur(truth, codes, wrap);
    const DebandedField field = deband(with(codes.clone(), wrap)).value();
    const double debanded = angle(truth, field);
    const Extent extent = heights.extent();
    std::printf("| %s | %.0f | %.3f | %.3f | %.2g | %.3f | %.2f | %.4f | %s |\n", name.c_str(),
                100.0 * static_cast<double>(field.report.terrace_texels) / static_cast<double>(extent.texels()),
                without, blur.angle, static_cast<double>(blur.sigma), debanded, without / debanded,
                angle(truth, with(deep.clone(), wrap)), rounds_to(codes, field.height) ? "yes" : "NO");
}

void print_maps() {
    std::printf(
        "\n| map | terraces, %% | 8 bits | best blur | its sigma | debanded | gain | 16 bits | rounds back |\n"
        "|---|---|---|---|---|---|---|---|---|\n");
    const std::filesystem::path folder = TEX_SOURCE_DIR "/../shared/data";
    std::vector<std::filesystem::path> files = {folder / "pairs/oiio_bump/height_half.exr"};
    if (std::filesystem::exists(folder / "height")) {
        for (const auto& entry : std::filesystem::directory_iterator(folder / "height")) files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    for (const std::filesystem::path& file : files) {
        const auto image = read_image(file.string());
        if (!image || (image->bits <= 8 && image->sample != SampleKind::floating)) continue;
        HeightOptions options;
        options.fill_invalid = true;
        const std::string name = file.stem().string();
        if (name.find("unfinished") != std::string::npos) options.no_data = -32768.0f;
        auto field = height_field(*image, options);
        if (!field) continue;
        const bool tiles = name.find("metal") != std::string::npos || name.find("terrain_") == 0;
        print_map(name, std::move(field->height), tiles ? Wrap::repeat : Wrap::clamp);
    }
    const Extent extent{512, 512};
    const auto hills = [](int i, int j) { return 0.5 + 0.4 * std::sin(0.01227 * i) * std::sin(0.01227 * j); };
    const auto low = [](int i, int j) {
        return 0.1 + 0.05 * std::sin(0.01227 * (i + j)) + 0.03 * std::cos(0.0245 * i);
    };
    const auto slope = [](int i, int j) { return 0.2 + 0.001 * i + 0.0004 * j; };
    const auto dome = [](int i, int j) {
        const double r = (i - 255.5) * (i - 255.5) + (j - 255.5) * (j - 255.5);
        return 0.8 * std::sqrt(std::max(0.0, 1.0 - r / (200.0 * 200.0)));
    };
    print_map("formula: hills", fields::plane_of(extent, hills), Wrap::repeat);
    print_map("formula: low relief", fields::plane_of(extent, low), Wrap::repeat);
    print_map("formula: slope", fields::plane_of(extent, slope), Wrap::clamp);
    print_map("formula: dome", fields::plane_of(extent, dome), Wrap::clamp);
}

}  // namespace

int main() {
    print_times();
    print_maps();
}
