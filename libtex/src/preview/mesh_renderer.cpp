// SPDX-License-Identifier: Apache-2.0

#include "preview/mesh_renderer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "preview/canvas.h"
#include "preview/mesh_body.h"
#include "preview/raster.h"
#include "threads/parallel.h"

namespace tex::inline v1::render {
namespace {

// Tags of lines; those of triangles are smaller.
constexpr std::uint32_t kFirstLine = 0x80000000;

// How much closer to the viewer a line is than its points, so that the triangles beside it do not hide it.
constexpr double kLift = 0.008;

constexpr std::size_t kVerticesPerPiece = 4096;

// The four vertices of a line's rectangle on the picture. A line of no length becomes a square.
std::array<RasterVertex, 4> rectangle(const View& view, const MeshLine& line, double width) {
    const Projected a = view.project(line.from, kLift), b = view.project(line.to, kLift);
    const Vec2 way{b.x - a.x, b.y - a.y};
    const double size = length(way);
    const Vec2 along = (size > 1e-6 ? way * (1.0 / size) : Vec2{1.0, 0.0}) * (width / 2.0), side{-along.y, along.x};
    const auto vertex = [](const Projected& end, Vec2 step) {
        return raster_vertex({end.x + step.x, end.y + step.y, end.nearness});
    };
    return {vertex(a, side - along), vertex(b, side + along), vertex(b, along - side),
            vertex(a, (side + along) * -1.0)};
}

Result<Raster> raster_of(const Stage& stage, const MeshLines& lines, const Execution& execution) {
    const MeshPart& part = stage.mesh->space().part;
    const std::size_t vertices = part.positions.size(), triangles = part.triangles();
    std::vector<RasterVertex> placed(vertices + 4 * lines.lines.size());
    std::vector<RasterTriangle> pieces(triangles + 2 * lines.lines.size());
    const auto place = [&](int begin, int end) {
        const std::size_t last = std::min(vertices, static_cast<std::size_t>(end) * kVerticesPerPiece);
        for (std::size_t v = static_cast<std::size_t>(begin) * kVerticesPerPiece; v < last; ++v)
            placed[v] = raster_vertex(stage.view.project(stage.mesh->place(v)));
    };
    const auto count = static_cast<int>((vertices + kVerticesPerPiece - 1) / kVerticesPerPiece);
    if (auto done = parallel_for(execution, count, 1, place); !done) return done.error();
    for (std::size_t t = 0; t < triangles; ++t) {
        const std::uint32_t* v = part.indices.data() + 3 * t;
        pieces[t] = {{v[0], v[1], v[2]}, static_cast<std::uint32_t>(t), true};
    }
    for (std::size_t k = 0; k < lines.lines.size(); ++k) {
        const auto first = static_cast<std::uint32_t>(vertices + 4 * k);
        const std::uint32_t tag = kFirstLine + static_cast<std::uint32_t>(k);
        const auto corners = rectangle(stage.view, lines.lines[k], lines.width);
        std::copy(corners.begin(), corners.end(), placed.begin() + first);
        pieces[triangles + 2 * k] = {{first, first + 1, first + 2}, tag, false};
        pieces[triangles + 2 * k + 1] = {{first, first + 2, first + 3}, tag, false};
    }
    return Raster::make(stage.size, std::move(placed), std::move(pieces));
}

// The samples of a pixel with the same tag.
struct Share {
    std::uint32_t tag = kNoTag;
    int count = 0;
    double x = 0.0, y = 0.0;  // sums of places in the pixel
};

class MeshPainter {
public:
    MeshPainter(const Stage& stage, Space space, const Surface& surface, const MeshLines& lines)
        : stage_(stage), surface_(surface), lines_(lines), space_(space), ground_(color_of(kGround)) {}

    [[nodiscard]] Vec3 pixel(const Raster::Band& band, int i, int j) const {
        const std::array<std::uint32_t, Raster::kSamples> tags = band.pixel(i, j);
        std::array<Share, Raster::kSamples> shares;
        int count = 0;
        for (int k = 0; k < Raster::kSamples; ++k) {
            const std::uint32_t tag = tags[static_cast<std::size_t>(k)];
            const auto end = shares.begin() + count;
            const auto share = std::find_if(shares.begin(), end, [&](const Share& s) { return s.tag == tag; });
            if (share == end) *share = {tag};
            count += share == end ? 1 : 0;
            ++share->count;
            const int column = k % Raster::kSide, row = k / Raster::kSide;
            share->x += (column + 0.5) / Raster::kSide;
            share->y += (row + 0.5) / Raster::kSide;
        }
        Vec3 sum;
        for (int k = 0; k < count; ++k) {
            const Share& share = shares[static_cast<std::size_t>(k)];
            sum = sum + color(share, i, j) * (static_cast<double>(share.count) / Raster::kSamples);
        }
        return sum;
    }

private:
    [[nodiscard]] Vec3 color_of(Code code) const {
        const Vec3 display{code.r / 255.0, code.g / 255.0, code.b / 255.0};
        if (space_ == Space::display) return display;
        return {srgb_to_linear(display.x), srgb_to_linear(display.y), srgb_to_linear(display.z)};
    }

    [[nodiscard]] Vec3 color(const Share& share, int i, int j) const {
        if (share.tag == kNoTag) return ground_;
        if (share.tag >= kFirstLine) return color_of(lines_.lines[share.tag - kFirstLine].color);
        const MeshHit found =
            stage_.mesh->meet(share.tag, stage_.view, i + share.x / share.count, j + share.y / share.count);
        return surface_(found.hit, found.footprint);
    }

    const Stage& stage_;
    const Surface& surface_;
    const MeshLines& lines_;
    Space space_;
    Vec3 ground_;
};

}  // namespace

Result<Texture> render_mesh(const Stage& stage, Space space, const Surface& surface, const MeshLines& lines,
                            const Execution& execution) {
    const auto raster = raster_of(stage, lines, part_of(execution, 0.0, 0.1));
    if (!raster) return raster.error();
    Canvas canvas(stage.size);
    const MeshPainter painter(stage, space, surface, lines);
    const auto code = space == Space::linear ? srgb_code : display_code;
    const auto draw = [&](int begin, int end) {
        Raster::Band band;
        for (int b = begin; b < end; ++b) {
            raster->draw(b, band);
            for (int j = band.first; j < band.first + band.rows; ++j) {
                for (int i = 0; i < stage.size.width; ++i) {
                    const Vec3 color = painter.pixel(band, i, j);
                    canvas.set(i, j, {code(color.x), code(color.y), code(color.z)});
                }
            }
        }
    };
    const Execution drawing = part_of(execution, 0.1, 1.0);
    if (auto done = parallel_for(drawing, raster->bands(), 1, draw); !done) return done.error();
    return std::move(canvas).take();
}

}  // namespace tex::inline v1::render
