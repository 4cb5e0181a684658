// SPDX-License-Identifier: Apache-2.0
// lod_bound_bench: how much of its original no normal map can give back to a LOD.
//
//     lod_bound_bench ORIGINAL OLD NEW [EXTENT]        glTF models: the LOD with the old map and with the new one
//
// A normal map has one vector for each place of a surface, and a simplified surface lies elsewhere: from other
// directions, other points of the original are seen there. The best map has, at each texel, the median of all normals
// of the original that are seen there: the vector from which their distances have the least sum, found in three passes
// (Weiszfeld). It is made here from 150 directions around the model, in EXTENT (that of the new
// map), and then looked at from the 26 of lod_bench, which are not among them. No map that rays or anything else makes
// can be much better: what it leaves is the shape's.
//
// Prints the mean difference of lit codes (diffuse light alone) from the original, and the mean angle between the
// normals in degrees, for the old map, the new one and the best one, over the pixels that lod_bench counts.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <tex/tex.h>

#include "preview/colormap.h"
#include "preview/mesh_body.h"
#include "preview/raster.h"
#include "preview/sampling.h"
#include "reports/lod_difference.h"

namespace {

using namespace tex;
using namespace tex::cli;
using namespace tex::render;

constexpr int kViews = 150, kPasses = 3;
constexpr double kLeast = 0.02;  // about a degree
constexpr double kDegrees = 57.29577951308232;

[[noreturn]] void fail(const std::string& why) {
    std::fprintf(stderr, "lod_bound_bench: %s\n", why.c_str());
    std::exit(1);
}

// What is seen at the pixels of a picture.
struct Seen {
    std::vector<bool> covered;
    std::vector<Vec3> normals;
    std::vector<Vec2> uvs;
};

// A map over a model of which a material is drawn.
struct Subject {
    explicit Subject(const LodMaterial& from)
        : drawn(from), space{from.selected.part, from.selected.tangents}, body(space),
          map(sampler_of(from.map, Wrap::repeat, Wrap::repeat)) {}
    const LodMaterial& drawn;
    TangentSpace space;
    MeshBody body;
    Sampler map;
};

Seen look(const Subject& of, const LodView& from) {
    const Extent size{kLodSide, kLodSide};
    const View view(Camera{from.yaw, from.pitch, 30.0f}, size, [](Vec3 d) { return 1.06 * length(d); });
    const MeshPart& part = of.drawn.selected.part;
    std::vector<RasterVertex> vertices;
    std::vector<RasterTriangle> triangles;
    for (std::size_t v = 0; v < part.positions.size(); ++v)
        vertices.push_back(raster_vertex(view.project(of.body.place(v))));
    for (std::size_t t = 0; t < part.triangles(); ++t) {
        const std::uint32_t* v = part.indices.data() + 3 * t;
        triangles.push_back({{v[0], v[1], v[2]}, static_cast<std::uint32_t>(t), true});
    }
    const auto raster = Raster::make(size, std::move(vertices), std::move(triangles));
    if (!raster) fail(raster.error().message());
    Seen seen;
    seen.covered.resize(std::size_t{kLodSide} * kLodSide);
    seen.normals.resize(seen.covered.size());
    seen.uvs.resize(seen.covered.size());
    Raster::Band band;
    for (int b = 0; b < raster->bands(); ++b) {
        raster->draw(b, band);
        for (int j = band.first; j < band.first + band.rows && j < kLodSide; ++j) {
            for (int i = 0; i < kLodSide; ++i) {
                const auto tags = band.pixel(i, j);
                const bool is_full = std::none_of(tags.begin(), tags.end(), [](auto tag) { return tag == kNoTag; });
                if (!is_full) continue;
                const auto p = static_cast<std::size_t>(j * kLodSide + i);
                const MeshHit found = of.body.meet(tags[5], view, i + 0.5, j + 0.5);
                const Sample n = sample(of.map, found.hit.uv, found.footprint, 8);
                seen.covered[p] = true;
                seen.uvs[p] = found.hit.uv;
                seen.normals[p] =
                    normalize(found.hit.tangent * n[0] + found.hit.binormal * n[1] + found.hit.normal * n[2]);
            }
        }
    }
    return seen;
}

double code_of(Vec3 normal, const Float3& light) {
    const Vec3 to =
        normalize({static_cast<double>(light.x), static_cast<double>(light.y), static_cast<double>(light.z)});
    return srgb_code(0.6 * (0.03 + std::max(0.0, dot(normal, to))));
}

double angle(Vec3 a, Vec3 b) { return kDegrees * std::acos(std::clamp(dot(a, b), -1.0, 1.0)); }

// Directions that cover the sphere evenly (Fibonacci).
std::vector<LodView> many_directions() {
    std::vector<LodView> all;
    for (int k = 0; k < kViews; ++k) {
        const double y = 1.0 - 2.0 * (k + 0.5) / kViews;
        all.push_back({static_cast<float>(std::fmod(k * 137.50776405003785, 360.0)),
                       static_cast<float>(std::clamp(std::asin(y) * kDegrees, -89.0, 89.0))});
    }
    return all;
}

// The sums of world normals at texels; each pixel counts at the four texels around its place.
class BestMap {
public:
    [[nodiscard]] Extent extent() const { return extent_; }
    explicit BestMap(Extent extent)
        : extent_(extent), sums_(static_cast<std::size_t>(extent.width) * static_cast<std::size_t>(extent.height)) {}

    void add(Vec2 uv, Vec3 normal) {
        visit(uv, [&](std::size_t texel, double weight) { sums_[texel] = sums_[texel] + normal * weight; });
    }
    [[nodiscard]] std::optional<Vec3> at(Vec2 uv) const {
        Vec3 sum;
        visit(uv, [&](std::size_t texel, double weight) {
            const double size = length(sums_[texel]);
            if (size > 0.0) sum = sum + sums_[texel] * (weight / size);
        });
        if (length(sum) < 1e-3) return std::nullopt;
        return normalize(sum);
    }

private:
    template <class Use>
    void visit(Vec2 uv, const Use& use) const {
        const double x = (uv.x - std::floor(uv.x)) * extent_.width - 0.5;
        const double y = (1.0 - (uv.y - std::floor(uv.y))) * extent_.height - 0.5;
        const double i = std::floor(x), j = std::floor(y);
        for (const int dy : {0, 1}) {
            for (const int dx : {0, 1}) {
                const int column = (static_cast<int>(i) + dx + extent_.width) % extent_.width;
                const int row = (static_cast<int>(j) + dy + extent_.height) % extent_.height;
                use(static_cast<std::size_t>(row) * static_cast<std::size_t>(extent_.width) +
                        static_cast<std::size_t>(column),
                    std::abs(1.0 - dx - (x - i)) * std::abs(1.0 - dy - (y - j)));
            }
        }
    }

    Extent extent_;
    std::vector<Vec3> sums_;
};

struct Sums {
    double codes = 0.0, degrees = 0.0;
};

}  // namespace

int main(int argc, char** argv) {
    if (argc == 1) {  // ninja bench
        std::puts("usage: lod_bound_bench ORIGINAL OLD NEW [EXTENT]; skipped: it needs models (tests/bench/lods.sh)");
        return 0;
    }
    if (argc < 4) fail("ORIGINAL OLD NEW [EXTENT]");
    std::array<std::vector<LodMaterial>, 3> models;
    for (std::size_t k = 0; k < 3; ++k) {
        auto read = lod_materials(argv[k + 1], {}, {});
        if (!read) fail(read.error().message());
        models[k] = std::move(*read);
    }
    frame_together({&models[0], &models[1], &models[2]});
    std::array<Sums, 3> sums;
    double count = 0.0;
    for (const LodMaterial& first : models[0]) {
        std::vector<std::unique_ptr<Subject>> same;
        for (const auto& model : models) {
            const auto found = std::find_if(model.begin(), model.end(),
                                            [&](const LodMaterial& drawn) { return drawn.name == first.name; });
            if (found != model.end()) same.push_back(std::make_unique<Subject>(*found));
        }
        if (same.size() != 3) continue;
        const int side = argc > 4 ? std::atoi(argv[4]) : 0;
        BestMap best(side > 0 ? Extent{side, side} : same[2]->drawn.map.levels.front().extent());
        for (int pass = 0; pass < kPasses; ++pass) {
            BestMap next(best.extent());
            for (const LodView& from : many_directions()) {
                const Seen original = look(*same[0], from), lod = look(*same[2], from);
                for (std::size_t p = 0; p < lod.covered.size(); ++p) {
                    if (!original.covered[p] || !lod.covered[p]) continue;
                    const Vec3 seen = original.normals[p];
                    const auto before = pass > 0 ? best.at(lod.uvs[p]) : std::nullopt;
                    next.add(lod.uvs[p], seen * (before ? 1.0 / std::max(length(*before - seen), kLeast) : 1.0));
                }
            }
            best = std::move(next);
        }
        for (const LodView& from : lod_views()) {
            const Seen original = look(*same[0], from), old_one = look(*same[1], from), new_one = look(*same[2], from);
            const auto a = far_inside(original.covered, kLodSide), b = far_inside(old_one.covered, kLodSide),
                       c = far_inside(new_one.covered, kLodSide);
            const Float3 light = lod_light(from);
            for (std::size_t p = 0; p < a.size(); ++p) {
                if (!a[p] || !b[p] || !c[p] || code_of(original.normals[p], light) < kLodLit) continue;
                const auto found = best.at(new_one.uvs[p]);
                if (!found) continue;
                count += 1.0;
                const std::array<Vec3, 3> normals = {old_one.normals[p], new_one.normals[p], *found};
                for (std::size_t k = 0; k < 3; ++k) {
                    sums[k].codes += std::abs(code_of(normals[k], light) - code_of(original.normals[p], light));
                    sums[k].degrees += angle(normals[k], original.normals[p]);
                }
            }
        }
    }
    if (count == 0.0) fail("no pixel is lit in all of them");
    for (const Sums& each : sums) std::printf("%.2f\t%.2f\t", each.codes / count, each.degrees / count);
    std::printf("\n");
    return 0;
}
