// SPDX-License-Identifier: Apache-2.0

#include "preview/uv_layout.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "preview/canvas.h"
#include "preview/legend.h"
#include "preview/raster.h"
#include "threads/parallel.h"

namespace tex::inline v1::render {
namespace {

constexpr Code kUpright{255, 255, 255}, kMirrored{255, 150, 40};
constexpr double kMapShare = 0.55;  // of the map's colours, so that lines stand out
constexpr double kFillShare = 0.12;
constexpr double kFarthestUv = 1e6;
constexpr double kLongestUv = 16.0;  // repeats of the map

// Copies of a triangle, on average, beyond a million, so that memory stays in proportion to the mesh.
constexpr std::size_t kMostCopies = 4, kFreeCopies = std::size_t{1} << 20;

// The least and the greatest whole repeat of the map that values touch.
struct Repeats {
    double first, last;
};

Repeats repeats_of(double a, double b, double c) {
    const double least = std::min({a, b, c}), greatest = std::max({a, b, c});
    const double first = std::floor(least);
    return {first, std::max(first, std::ceil(greatest) - 1.0)};
}

// Corners of all triangles on the picture: once for each repeat of the map that a triangle touches.
class Layout {
public:
    Layout(Extent size, std::size_t triangles)
        : size_(size), most_vertices_(3 * (kFreeCopies + kMostCopies * triangles)) {}

    Result<void> add(const std::array<Vec2, 3>& uvs) {
        const Repeats across = repeats_of(uvs[0].x, uvs[1].x, uvs[2].x);
        const Repeats up = repeats_of(uvs[0].y, uvs[1].y, uvs[2].y);
        const bool near = std::max({std::abs(across.first), std::abs(across.last), std::abs(up.first),
                                    std::abs(up.last)}) <= kFarthestUv;
        if (!near) return Error{ErrorCode::unsupported, {}, "UVs of the mesh are beyond a million"};
        if (across.last - across.first > kLongestUv || up.last - up.first > kLongestUv)
            return Error{ErrorCode::unsupported, {}, "a triangle of the mesh covers more than 16 repeats of the map"};
        const auto rows = static_cast<int>(up.last - up.first), columns = static_cast<int>(across.last - across.first);
        for (int j = 0; j <= rows; ++j) {
            for (int i = 0; i <= columns; ++i) put(uvs, {across.first + i, up.first + j});
        }
        if (vertices_.size() > most_vertices_)
            return Error{ErrorCode::unsupported, {}, "triangles of the mesh cover more than 4 repeats of the map"};
        return {};
    }

    Result<Raster> raster() && { return Raster::make(size_, std::move(vertices_), std::move(triangles_)); }

private:
    void put(const std::array<Vec2, 3>& uvs, Vec2 origin) {
        const auto first = static_cast<std::uint32_t>(vertices_.size());
        for (const Vec2 uv : uvs) {
            const Vec2 place = uv - origin;
            vertices_.push_back(raster_vertex({place.x * size_.width, (1.0 - place.y) * size_.height, 1.0}));
        }
        triangles_.push_back({{first, first + 1, first + 2}, first, false});
    }

    Extent size_;
    std::size_t most_vertices_;
    std::vector<RasterVertex> vertices_;
    std::vector<RasterTriangle> triangles_;
};

double distance_to_line(Vec2 point, Vec2 from, Vec2 to) {
    const Vec2 way = to - from, step = point - from;
    const double size = length(way);
    return size > 0.0 ? std::abs(way.x * step.y - way.y * step.x) / size : 1e9;
}

class LayoutPainter {
public:
    LayoutPainter(const Raster& raster, const Sampler& map, Extent size, double width, int anisotropy)
        : raster_(raster), map_(map), size_(size), width_(width), anisotropy_(anisotropy) {}

    [[nodiscard]] Vec3 pixel(const Raster::Band& band, int i, int j) const {
        const Vec2 uv{(i + 0.5) / size_.width, 1.0 - (j + 0.5) / size_.height};
        const Sample s = sample(map_, uv, {{1.0 / size_.width, 0.0}, {0.0, -1.0 / size_.height}}, anisotropy_);
        const Vec3 ground = Vec3{s[0] + 1.0, s[1] + 1.0, s[2] + 1.0} * (0.5 * kMapShare);
        Vec3 sum;
        const auto tags = band.pixel(i, j);
        for (int k = 0; k < Raster::kSamples; ++k) {
            const int column = k % Raster::kSide, row = k / Raster::kSide;
            const Vec2 at{i + (column + 0.5) / Raster::kSide, j + (row + 0.5) / Raster::kSide};
            sum = sum + over(ground, tags[static_cast<std::size_t>(k)], at);
        }
        return sum * (1.0 / Raster::kSamples);
    }

private:
    // The colour of a sample at a place of the picture. The tag is the first vertex of a triangle.
    [[nodiscard]] Vec3 over(Vec3 ground, std::uint32_t tag, Vec2 at) const {
        if (tag == kNoTag) return ground;
        std::array<Vec2, 3> corners;
        for (std::uint32_t k = 0; k < 3; ++k) {
            const RasterVertex& v = raster_.vertex(tag + k);
            corners[k] = {static_cast<double>(v.x) / Raster::kUnits, static_cast<double>(v.y) / Raster::kUnits};
        }
        double nearest = 1e9;
        for (std::size_t k = 0; k < 3; ++k)
            nearest = std::min(nearest, distance_to_line(at, corners[k], corners[(k + 1) % 3]));
        const Vec2 a = corners[1] - corners[0], b = corners[2] - corners[0];
        const Code code = a.x * b.y - a.y * b.x < 0.0 ? kUpright : kMirrored;
        const double share = nearest < width_ ? 1.0 : kFillShare;
        const Vec3 line{code.r / 255.0, code.g / 255.0, code.b / 255.0};
        return ground * (1.0 - share) + line * share;
    }

    const Raster& raster_;
    const Sampler& map_;
    Extent size_;
    double width_;  // of the half of a line on its triangle
    int anisotropy_;
};

}  // namespace

Result<Texture> uv_layout(const MeshBody& mesh, const PreviewScene& scene, const PreviewOptions& options, Extent size,
                          const Execution& execution) {
    Layout layout(size, mesh.triangles());
    for (std::size_t t = 0; t < mesh.triangles(); ++t) {
        if (const auto added = layout.add(mesh.uvs(t)); !added) return added.error();
    }
    const auto raster = std::move(layout).raster();
    if (!raster) return raster.error();
    const Sampler map = sampler_of(*scene.map, options.wrap_x, options.wrap_y);
    const LayoutPainter painter(*raster, map, size, 0.5 * text_scale(size.width), options.anisotropy);
    Canvas canvas(size);
    const auto draw = [&](int begin, int end) {
        Raster::Band band;
        for (int b = begin; b < end; ++b) {
            raster->draw(b, band);
            for (int j = band.first; j < band.first + band.rows; ++j) {
                for (int i = 0; i < size.width; ++i) {
                    const Vec3 color = painter.pixel(band, i, j);
                    canvas.set(i, j, {display_code(color.x), display_code(color.y), display_code(color.z)});
                }
            }
        }
    };
    if (auto done = parallel_for(execution, raster->bands(), 1, draw); !done) return done.error();
    Texture picture = std::move(canvas).take();
    if (!options.legend) return picture;
    return with_key(std::move(picture), {{"triangles", kUpright}, {"mirrored triangles", kMirrored}});
}

}  // namespace tex::inline v1::render
