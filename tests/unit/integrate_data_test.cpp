// SPDX-License-Identifier: Apache-2.0
// integrate() after bake() on real height maps: DEMs in metres, 8-bit terraces, sensor noise.

#include <tex/surface.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <tex/bake.h>
#include <tex/file.h>

#include "unit/textures.h"

namespace {

using namespace tex;

constexpr double kLimit = 1e-3;  // of the range
constexpr GradientKernel kExact[] = {GradientKernel::forward, GradientKernel::central, GradientKernel::scharr};

std::vector<std::string> height_maps() {
    std::vector<std::string> files;
    for (const auto& entry : std::filesystem::directory_iterator(shared_data() / "height"))
        files.push_back(entry.path().string());
    std::sort(files.begin(), files.end());
    return files;
}

// With a relief of eight texels, whatever the unit.
HeightField read_heights(const std::string& path) {
    HeightOptions options;
    options.fill_invalid = true;
    if (path.find("nodata") != std::string::npos) options.no_data = -9999.0f;
    HeightField field = std::move(height_field(read_image(path).value(), options).value());
    field.ground.reset();
    float low = field.height.at(0, 0), high = low;
    for (int j = 0; j < field.height.extent().height; ++j) {
        const float* const row = field.height.row(j);
        low = std::min(low, *std::min_element(row, row + field.height.extent().width));
        high = std::max(high, *std::max_element(row, row + field.height.extent().width));
    }
    field.bumpiness_x = high > low ? 8.0f / (high - low) : 1.0f;
    field.bumpiness_y = 0.75f * field.bumpiness_x;
    return field;
}

// The first texels of a field, so many that both extents are odd.
HeightField odd_piece(const HeightField& field, int most) {
    const Extent all = field.height.extent();
    const auto odd = [most](int n) { return (std::min(n, most) - 1) / 2 * 2 + 1; };
    HeightField piece;
    piece.height = Plane<float>({odd(all.width), odd(all.height)});
    piece.bumpiness_x = field.bumpiness_x;
    piece.bumpiness_y = field.bumpiness_y;
    for (int j = 0; j < piece.height.extent().height; ++j)
        std::copy_n(field.height.row(j), piece.height.extent().width, piece.height.row(j));
    return piece;
}

// The largest difference, relative to the range, without the constant and what central differences do not see: what
// alternates along axes that repeat and are even, or along both.
double error_of(const Plane<float>& is, const Plane<float>& truth, Wrap wrap) {
    const Extent extent = truth.extent();
    double parts[4] = {};
    const auto is_blind = [&](int part) {
        const bool x = (part & 1) == 0 || (wrap == Wrap::repeat && extent.width % 2 == 0);
        return x && ((part & 2) == 0 || (wrap == Wrap::repeat && extent.height % 2 == 0));
    };
    const auto sign = [](int part, int i, int j) {
        return ((part & 1) != 0 && i % 2 != 0) != ((part & 2) != 0 && j % 2 != 0) ? -1.0 : 1.0;
    };
    const auto difference = [&](int i, int j) {
        return static_cast<double>(is.at(i, j)) - static_cast<double>(truth.at(i, j));
    };
    float low = truth.at(0, 0), high = low;
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            for (int k = 0; k < 4; ++k) {
                if (is_blind(k)) parts[k] += sign(k, i, j) * difference(i, j) / static_cast<double>(extent.texels());
            }
            low = std::min(low, truth.at(i, j));
            high = std::max(high, truth.at(i, j));
        }
    }
    double largest = 0.0;
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            double rest = difference(i, j);
            for (int k = 0; k < 4; ++k) rest -= sign(k, i, j) * parts[k];
            largest = std::max(largest, std::abs(rest));
        }
    }
    return high > low ? largest / static_cast<double>(high - low) : largest;
}

double error_of_round_trip(const HeightField& field, const BakeOptions& with = {}) {
    const auto map = bake(field, with);
    IntegrateOptions options;
    options.bake = with;
    options.bumpiness_x = field.bumpiness_x;
    options.bumpiness_y = field.bumpiness_y;
    options.wrap_x = field.wrap_x;
    options.wrap_y = field.wrap_y;
    const auto result = integrate(*map, options);
    return error_of(result->field.height, field.height, field.wrap_x);
}

TEST(IntegrateData, KernelsThatSeeEverythingGiveRealHeightsBackInEveryWrap) {
    TEX_NEEDS_SHARED_DATA();
    for (const std::string& path : height_maps()) {
        HeightField piece = odd_piece(read_heights(path), 301);
        for (const GradientKernel kernel : kExact) {
            for (const auto& wrap : kWrapNames) {
                piece.wrap_x = piece.wrap_y = wrap.value;
                EXPECT_LT(error_of_round_trip(piece, {kernel, 1.0f}), kLimit)
                    << path << " " << name_of(kGradientKernelNames, kernel) << " " << wrap.name;
            }
        }
    }
}

TEST(IntegrateData, WholeMapsComeBackApartFromWhatAlternates) {
    TEX_NEEDS_SHARED_DATA();
    for (const std::string& path : height_maps()) {
        HeightField field = read_heights(path);
        for (const auto& wrap : kWrapNames) {
            if (wrap.value != Wrap::repeat && field.height.extent().texels() > 4 << 20) continue;  // takes seconds
            field.wrap_x = field.wrap_y = wrap.value;
            EXPECT_LT(error_of_round_trip(field), kLimit) << path << " " << wrap.name;
        }
    }
}

}  // namespace
