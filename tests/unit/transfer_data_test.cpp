// SPDX-License-Identifier: Apache-2.0
// Real height maps, displaced over a mesh, come back: ../shared/data. The table of tests/bench/RAYS.md.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <tex/bake.h>
#include <tex/file.h>
#include <tex/mesh.h>

#include "unit/textures.h"
#include "unit/transfers.h"

namespace tex {
namespace {

constexpr Extent kCropped{96, 96};

// The middle of a picture, with heights from 0 to `height` texels.
HeightField middle_of(const Image& image, float height) {
    HeightField field{Plane<float>(kCropped), 1.0f, 1.0f, Wrap::clamp, Wrap::clamp};
    const Extent all = image.planes[0].extent();
    const int left = (all.width - kCropped.width) / 2, top = (all.height - kCropped.height) / 2;
    float low = 1e30f, high = -1e30f;
    for (int j = 0; j < kCropped.height; ++j) {
        for (int i = 0; i < kCropped.width; ++i) {
            const float value = image.planes[0].at(left + i, top + j);
            field.height.at(i, j) = value;
            low = std::min(low, value);
            high = std::max(high, value);
        }
    }
    for (int j = 0; j < kCropped.height; ++j) {
        for (int i = 0; i < kCropped.width; ++i)
            field.height.at(i, j) = height * (field.height.at(i, j) - low) / (high - low);
    }
    return field;
}

// Through the heights of texels before, here, and two after: a curve whose slope at texels is the central difference
// (Catmull, Rom, 1974).
float curve(const std::array<float, 4>& h, float t) {
    const float a = 0.5f * (3.0f * (h[1] - h[2]) + h[3] - h[0]), b = h[0] - 2.5f * h[1] + 2.0f * h[2] - 0.5f * h[3];
    return h[1] + t * (0.5f * (h[2] - h[0]) + t * (b + t * a));
}

// n vertices a texel in each direction, from centre to centre, on such curves.
Plane<float> divided(const Plane<float>& heights, int n) {
    const auto along = [&](const auto& at, int size, int place) {
        const int k = std::min(place / n, size - 2);
        std::array<float, 4> h{};
        for (int c = 0; c < 4; ++c) h[static_cast<std::size_t>(c)] = at(std::clamp(k - 1 + c, 0, size - 1));
        return curve(h, static_cast<float>(place - k * n) / static_cast<float>(n));
    };
    const auto [width, height] = heights.extent();
    Plane<float> wide({(width - 1) * n + 1, height}), fine({(width - 1) * n + 1, (height - 1) * n + 1});
    for (int j = 0; j < height; ++j) {
        for (int i = 0; i < wide.extent().width; ++i)
            wide.at(i, j) = along([&](int c) { return heights.at(c, j); }, width, i);
    }
    for (int j = 0; j < fine.extent().height; ++j) {
        for (int i = 0; i < fine.extent().width; ++i)
            fine.at(i, j) = along([&](int c) { return wide.at(i, c); }, height, j);
    }
    return fine;
}

// With the normals that a modelling program gives it: those of the triangles around a vertex, weighted by their areas.
MeshPart displaced_mesh(const HeightField& field, int n) {
    const Plane<float> heights = divided(field.height, n);
    const auto [width, height] = heights.extent();
    const float step = 1.0f / static_cast<float>(n);
    MeshPart part;
    for (int j = 0; j < height; ++j) {
        for (int i = 0; i < width; ++i)
            part.positions.push_back({static_cast<float>(i) * step + 0.5f,
                                      static_cast<float>(kCropped.height) - 0.5f - static_cast<float>(j) * step,
                                      heights.at(i, j)});
    }
    for (int j = 1; j < height; ++j) {
        for (int i = 1; i < width; ++i) {
            const auto c = static_cast<std::uint32_t>(j * width + i), a = c - 1,
                       above = c - static_cast<std::uint32_t>(width);
            for (const std::uint32_t v : {a, c, above, a, above, above - 1}) part.indices.push_back(v);
        }
    }
    part.normals.resize(part.positions.size());
    for (std::size_t t = 0; t < part.indices.size(); t += 3) {
        const Float3 p = part.positions[part.indices[t]], q = part.positions[part.indices[t + 1]],
                     r = part.positions[part.indices[t + 2]];
        const Float3 x{q.x - p.x, q.y - p.y, q.z - p.z}, y{r.x - p.x, r.y - p.y, r.z - p.z};
        for (std::size_t k = 0; k < 3; ++k) {
            Float3& n = part.normals[part.indices[t + k]];
            n = {n.x + x.y * y.z - x.z * y.y, n.y + x.z * y.x - x.x * y.z, n.z + x.x * y.y - x.y * y.x};
        }
    }
    return part;
}

struct Came {
    double mean = 0.0, p99 = 0.0;  // degrees
    float height = 0.0f;           // the largest difference, in texels
};

// Without the outermost texels, where vertices have triangles on one side alone.
Came came_back(const HeightField& field, int n) {
    const auto baked = bake(field);
    const auto maps = transferred(flat_square(kCropped), only(displaced_mesh(field, n)), kCropped);
    EXPECT_TRUE(baked && maps);
    if (!baked || !maps) return {};
    EXPECT_EQ(maps->missed, 0);
    Came came;
    std::vector<double> angles;
    for (int j = 1; j + 1 < kCropped.height; ++j) {
        for (int i = 1; i + 1 < kCropped.width; ++i) {
            angles.push_back(degrees_between(vector_at(*baked, i, j), vector_at(maps->map, i, j)));
            came.mean += angles.back();
            came.height = std::max(came.height, std::abs(maps->heights.at(i, j) - field.height.at(i, j)));
        }
    }
    came.mean /= static_cast<double>(angles.size());
    std::sort(angles.begin(), angles.end());
    came.p99 = angles[angles.size() * 99 / 100];
    return came;
}

TEST(TransferData, RealHeightMapsDisplacedOverAMeshComeBack) {
    TEX_NEEDS_SHARED_DATA();
    for (const std::string name : {"metal_plate_disp_1k_1024x1024_u16.png", "dem_puget_sound_1025x1025_u16.png",
                                   "marble_tiles_600x600_u8.jpg"}) {
        const auto image = read_image((shared_data() / "height" / name).string());
        ASSERT_TRUE(image) << name;
        const HeightField field = middle_of(*image, 8.0f);
        Came before;
        for (const int n : {1, 2, 4, 8}) {
            const Came came = came_back(field, n);
            EXPECT_LT(came.height, 1e-5f) << name;
            if (n > 1) {
                EXPECT_LT(came.mean, 0.9 * before.mean) << name << " " << n;
            }
            if (n == 8) {
                EXPECT_LT(came.mean, 0.65 * before.mean) << name;  // from here on by a half
            }
            before = came;
        }
        EXPECT_LT(before.mean, name.ends_with(".jpg") ? 1.5 : 0.6) << name;
    }
}

}  // namespace
}  // namespace tex
