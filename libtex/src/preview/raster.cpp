// SPDX-License-Identifier: Apache-2.0

#include "preview/raster.h"

#include <algorithm>
#include <utility>

#include "mesh/triangle_edge.h"

namespace tex::inline v1::render {
namespace {

constexpr int kSpacing = Raster::kUnits / Raster::kSide;  // from a sample to the next
constexpr int kFirst = kSpacing / 2;                      // the place of the first sample

// So many samples may be tested in pictures of any size: this takes seconds.
constexpr double kFreeTests = 4294967296.0;

// The first sample of an axis at or beyond a place, and the last one at or before it.
int sample_from(std::int32_t place) { return static_cast<int>(floor_div(place - kFirst + kSpacing - 1, kSpacing)); }
int sample_to(std::int32_t place) { return static_cast<int>(floor_div(place - kFirst, kSpacing)); }

TrianglePoint point_of(const RasterVertex& vertex) { return {vertex.x, vertex.y}; }
std::int64_t area_of(const RasterVertex& a, const RasterVertex& b, const RasterVertex& c) {
    return twice_area(point_of(a), point_of(b), point_of(c));
}

// Samples, first and last included.
struct Box {
    int left, right, top, bottom;
    [[nodiscard]] bool empty() const { return left > right || top > bottom; }
};

Box box_of(const RasterVertex& a, const RasterVertex& b, const RasterVertex& c, Extent picture) {
    return {std::max(0, sample_from(std::min({a.x, b.x, c.x}))),
            std::min(picture.width * Raster::kSide - 1, sample_to(std::max({a.x, b.x, c.x}))),
            std::max(0, sample_from(std::min({a.y, b.y, c.y}))),
            std::min(picture.height * Raster::kSide - 1, sample_to(std::max({a.y, b.y, c.y})))};
}

}  // namespace

RasterVertex raster_vertex(const Projected& point) {
    const auto rounded = [](double pixels) {
        constexpr double kFarthest = 1048576.0;
        const double bounded = pixels > -kFarthest ? std::min(pixels, kFarthest) : -kFarthest;
        const double units = bounded * Raster::kUnits + 0.5;
        const auto down = static_cast<std::int32_t>(units);  // towards zero
        return static_cast<double>(down) > units ? down - 1 : down;
    };
    return {rounded(point.x), rounded(point.y), point.nearness};
}

std::array<std::uint32_t, Raster::kSamples> Raster::Band::pixel(int i, int j) const {
    std::array<std::uint32_t, kSamples> found;
    for (int b = 0; b < kSide; ++b) {
        const std::size_t row = static_cast<std::size_t>((j - first) * kSide + b) * static_cast<std::size_t>(stride);
        for (int a = 0; a < kSide; ++a) {
            const int sample = b * kSide + a, column = i * kSide + a;
            found[static_cast<std::size_t>(sample)] = tags[row + static_cast<std::size_t>(column)];
        }
    }
    return found;
}

Result<Raster> Raster::make(Extent picture, std::vector<RasterVertex> vertices, std::vector<RasterTriangle> triangles) {
    Raster raster;
    raster.picture_ = picture;
    raster.vertices_ = std::move(vertices);
    raster.triangles_ = std::move(triangles);
    if (const auto sorted = raster.sort(); !sorted) return sorted.error();
    return raster;
}

Raster::Rows Raster::bands_of(const RasterTriangle& t) const {
    const RasterVertex &a = vertices_[t.vertex[0]], &b = vertices_[t.vertex[1]], &c = vertices_[t.vertex[2]];
    const std::int64_t area = area_of(a, b, c);
    if (area == 0 || (t.one_sided && area > 0)) return {};
    const Box box = box_of(a, b, c, picture_);
    if (box.empty()) return {};
    return {box.top / (kSide * kBandRows), box.bottom / (kSide * kBandRows)};
}

Result<void> Raster::sort() {
    const double most = kFreeTests + static_cast<double>(kMostLayers) * kSamples * static_cast<double>(picture_.width) *
                                         static_cast<double>(picture_.height);
    double tests = 0.0;
    std::vector<std::size_t> counts(static_cast<std::size_t>(bands()) + 1);
    for (std::size_t k = 0; k < triangles_.size(); ++k) {
        const RasterTriangle& t = triangles_[k];
        const Rows rows = bands_of(t);
        if (rows.last < rows.first) continue;
        const Box box = box_of(vertices_[t.vertex[0]], vertices_[t.vertex[1]], vertices_[t.vertex[2]], picture_);
        tests += static_cast<double>(box.right - box.left + 1) * static_cast<double>(box.bottom - box.top + 1);
        if (rows.last - rows.first >= kMostLists) {
            tall_.push_back(static_cast<std::uint32_t>(k));
            continue;
        }
        for (int band = rows.first; band <= rows.last; ++band) ++counts[static_cast<std::size_t>(band) + 1];
    }
    if (tests > most) {
        return Error{ErrorCode::unsupported, {}, "triangles of the mesh hide each other more than 1024 deep"};
    }
    for (std::size_t band = 1; band < counts.size(); ++band) counts[band] += counts[band - 1];
    starts_ = counts;
    listed_.resize(counts.back());
    for (std::size_t k = 0; k < triangles_.size(); ++k) {
        const Rows rows = bands_of(triangles_[k]);
        if (rows.last - rows.first >= kMostLists) continue;
        for (int band = rows.first; band <= rows.last; ++band)
            listed_[counts[static_cast<std::size_t>(band)]++] = static_cast<std::uint32_t>(k);
    }
    return {};
}

void Raster::draw(int band, Band& result) const {
    result.first = band * kBandRows;
    result.rows = std::min(kBandRows, picture_.height - result.first);
    result.stride = picture_.width * kSide;
    const std::size_t samples =
        static_cast<std::size_t>(result.stride) * static_cast<std::size_t>(result.rows) * std::size_t{kSide};
    result.tags.assign(samples, kNoTag);
    result.nearness.assign(samples, 0.0);
    const auto b = static_cast<std::size_t>(band);
    for (std::size_t k = starts_[b]; k < starts_[b + 1]; ++k) draw_triangle(triangles_[listed_[k]], result);
    for (const std::uint32_t k : tall_) draw_triangle(triangles_[k], result);
}

void Raster::draw_triangle(const RasterTriangle& t, Band& band) const {
    const RasterVertex &a = vertices_[t.vertex[0]], *b = &vertices_[t.vertex[1]], *c = &vertices_[t.vertex[2]];
    std::int64_t area = area_of(a, *b, *c);
    if (area < 0) {
        std::swap(b, c);
        area = -area;
    }
    Box box = box_of(a, *b, *c, picture_);
    box.top = std::max(box.top, band.first * kSide);
    box.bottom = std::min(box.bottom, (band.first + band.rows) * kSide - 1);
    if (box.empty()) return;
    const TrianglePoint start{kSpacing * box.left + kFirst, kSpacing * box.top + kFirst};
    TriangleEdge edges[3] = {{point_of(a), point_of(*b), start, kSpacing},
                             {point_of(*b), point_of(*c), start, kSpacing},
                             {point_of(*c), point_of(a), start, kSpacing}};

    // The plane of nearness over the picture.
    const double bx = b->x - a.x, by = b->y - a.y, cx = c->x - a.x, cy = c->y - a.y;
    const double nb = b->nearness - a.nearness, nc = c->nearness - a.nearness;
    const double across = (nb * cy - nc * by) / static_cast<double>(area);
    const double down = (nc * bx - nb * cx) / static_cast<double>(area);
    for (int row = box.top; row <= box.bottom; ++row) {
        std::int64_t first = 0, last = box.right - box.left;
        for (TriangleEdge& edge : edges) {
            edge.clip(first, last);
            edge.next_row();
        }
        const double of_row = a.nearness + down * static_cast<double>(kSpacing * row + kFirst - a.y);
        const std::size_t at =
            static_cast<std::size_t>(row - band.first * kSide) * static_cast<std::size_t>(band.stride) +
            static_cast<std::size_t>(box.left);
        for (std::int64_t k = first; k <= last; ++k) {
            const auto x = static_cast<double>(kSpacing * (box.left + k) + kFirst - a.x);
            const double nearness = of_row + across * x;
            const std::size_t place = at + static_cast<std::size_t>(k);
            std::uint32_t& tag = band.tags[place];
            double& nearest = band.nearness[place];
            if (tag != kNoTag && !(nearness > nearest || (nearness == nearest && t.tag < tag))) continue;
            tag = t.tag;
            nearest = nearness;
        }
    }
}

}  // namespace tex::inline v1::render
