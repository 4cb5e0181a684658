// SPDX-License-Identifier: Apache-2.0
// raster.h: which of many triangles is nearest at each sample of a picture.
//
// A pixel has kSide x kSide samples, in a regular grid. Corners are rounded to 1/256 pixel, and a sample on an edge
// belongs to the triangle above or to the left of which it does not lie (the top-left rule of GPUs), so triangles that
// share an edge leave no crack and do not overlap. All this is exact in integers.

#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <tex/types.h>

namespace tex::inline v1::render {

// A point of the picture: pixels from its top left corner. Greater `nearness` hides less; between two points of space
// it is linear over the picture.
struct Projected {
    double x = 0.0, y = 0.0, nearness = 0.0;
};

struct RasterVertex {
    std::int32_t x = 0, y = 0;  // in kUnits a pixel
    double nearness = 0.0;
};

// Rounds; what is farther than 2^20 pixels away, or NaN, is moved there.
[[nodiscard]] RasterVertex raster_vertex(const Projected& point);

// The tag says what a triangle is. Of triangles that are equally near, the one with the least tag is seen.
struct RasterTriangle {
    std::array<std::uint32_t, 3> vertex{};
    std::uint32_t tag = 0;
    bool one_sided = false;  // is not drawn if its vertices are clockwise in the picture
};

inline constexpr std::uint32_t kNoTag = 0xffffffff;

class Raster {
public:
    static constexpr int kUnits = 256;
    static constexpr int kSide = 4;
    static constexpr int kSamples = kSide * kSide;
    static constexpr int kBandRows = 8;

    // Errors: unsupported (the triangles cover each pixel more than kMostLayers times, on average).
    static constexpr int kMostLayers = 1024;
    static Result<Raster> make(Extent picture, std::vector<RasterVertex> vertices,
                               std::vector<RasterTriangle> triangles);

    [[nodiscard]] const RasterVertex& vertex(std::uint32_t index) const { return vertices_[index]; }

    // What is seen in a band of rows of the picture: tags of the samples, row by row. kNoTag: nothing.
    struct Band {
        int first = 0, rows = 0;  // of the picture
        int stride = 0;           // samples of a row
        std::vector<std::uint32_t> tags;
        std::vector<double> nearness;

        // The tags of a pixel, row by row.
        [[nodiscard]] std::array<std::uint32_t, kSamples> pixel(int i, int j) const;
    };
    [[nodiscard]] int bands() const { return (picture_.height + kBandRows - 1) / kBandRows; }
    void draw(int band, Band& result) const;

private:
    // Triangles that touch at most so many bands are listed in each of them.
    static constexpr int kMostLists = 4;

    struct Rows {
        int first = 0, last = -1;  // bands
    };
    // The bands that the triangle touches; none if it is not drawn.
    [[nodiscard]] Rows bands_of(const RasterTriangle& triangle) const;
    Result<void> sort();
    void draw_triangle(const RasterTriangle& triangle, Band& band) const;

    Extent picture_;
    std::vector<RasterVertex> vertices_;
    std::vector<RasterTriangle> triangles_;
    std::vector<std::uint32_t> listed_;  // triangles by band
    std::vector<std::size_t> starts_;    // of the bands in listed_
    std::vector<std::uint32_t> tall_;    // triangles that touch more bands
};

}  // namespace tex::inline v1::render
