// SPDX-License-Identifier: Apache-2.0
// bake() against the double-precision reference on real height maps: DEMs in metres, 8-bit terraces, sensor noise.

#include <tex/bake.h>
#include <tex/file.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "reference/bake.h"
#include "unit/textures.h"

namespace {

constexpr double kLimit = 0.01;  // degrees
constexpr int kPiece =
    192;  // side, in texels, of the area on which every kernel and wrap is tried; whole maps get the shader's kernel

std::vector<std::string> height_maps() {
    std::vector<std::string> files;
    for (const auto& entry : std::filesystem::directory_iterator(tex::shared_data() / "height"))
        files.push_back(entry.path().string());
    std::sort(files.begin(), files.end());
    return files;
}

tex::HeightField read_heights(const std::string& path) {
    tex::HeightOptions options;
    options.fill_invalid = true;
    if (path.find("nodata") != std::string::npos) options.no_data = -9999.0f;
    tex::HeightField field = tex::height_field(tex::read_image(path).value(), options).value();
    // A relief of eight texels, whatever the unit.
    float least = field.height.at(0, 0);
    float greatest = least;
    for (int j = 0; j < field.height.extent().height; ++j) {
        const float* row = field.height.row(j);
        const auto [low, high] = std::minmax_element(row, row + field.height.extent().width);
        least = std::min(least, *low);
        greatest = std::max(greatest, *high);
    }
    field.bumpiness_x = greatest > least ? 8.0f / (greatest - least) : 1.0f;
    field.bumpiness_y = 0.75f * field.bumpiness_x;
    return field;
}

// The middle of a field, as a separate field.
tex::HeightField middle(const tex::HeightField& field) {
    const tex::Extent all = field.height.extent();
    const tex::Extent extent{std::min(all.width, kPiece), std::min(all.height, kPiece)};
    tex::HeightField piece;
    piece.height = tex::Plane<float>(extent);
    piece.bumpiness_x = field.bumpiness_x;
    piece.bumpiness_y = field.bumpiness_y;
    for (int j = 0; j < extent.height; ++j) {
        const float* row = field.height.row(j + (all.height - extent.height) / 2) + (all.width - extent.width) / 2;
        std::copy(row, row + extent.width, piece.height.row(j));
    }
    return piece;
}

TEST(BakeData, EveryKernelAndWrapAgreesWithTheReferenceOnRealHeights) {
    TEX_NEEDS_SHARED_DATA();
    for (const std::string& path : height_maps()) {
        tex::HeightField piece = middle(read_heights(path));
        for (const auto& kernel : tex::kGradientKernelNames) {
            for (const auto& wrap : tex::kWrapNames) {
                piece.wrap_x = piece.wrap_y = wrap.value;
                const tex::BakeOptions options{kernel.value, 1.0f};
                const double angle =
                    largest_angle(tex::bake(piece, options).value(), tex::reference::bake(piece, options));
                EXPECT_LT(angle, kLimit) << path << " " << kernel.name << " " << wrap.name;
            }
        }
    }
}

TEST(BakeData, WholeMapsAgreeWithTheReference) {
    TEX_NEEDS_SHARED_DATA();
    double worst = 0.0;
    for (const std::string& path : height_maps()) {
        tex::HeightField field = read_heights(path);
        field.ground.reset();  // the reference knows bumpiness alone
        const double angle = largest_angle(tex::bake(field).value(), tex::reference::bake(field, {}));
        EXPECT_LT(angle, kLimit) << path;
        worst = std::max(worst, angle);
    }
    std::printf("largest angle to the reference over all maps: %.2g degrees\n", worst);
}

}  // namespace
