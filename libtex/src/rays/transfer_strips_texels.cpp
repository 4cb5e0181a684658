// SPDX-License-Identifier: Apache-2.0

#include "rays/transfer_strips.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "mesh/frames.h"

namespace tex::inline v1 {
namespace {

// The smallest of those that are the most frequent. Sorts them.
std::int32_t most_frequent(std::vector<std::int32_t>& ids) {
    std::sort(ids.begin(), ids.end());
    std::int32_t best = kNoId;
    std::size_t most = 0;
    for (std::size_t first = 0, end = 0; first < ids.size(); first = end) {
        for (end = first; end < ids.size() && ids[end] == ids[first];) ++end;
        if (end - first <= most) continue;
        most = end - first;
        best = ids[first];
    }
    return best;
}

// Sets a texel of a map of vectors.
void put(NormalMap& map, int i, int j, Vector3 n) {
    map.x.at(i, j) = static_cast<float>(n.x);
    map.y.at(i, j) = static_cast<float>(n.y);
    map.z.at(i, j) = static_cast<float>(n.z);
}

}  // namespace

bool TransferStrips::wants_more() const {
    return scene_.second != nullptr || scene_.surface.has_ids() || scene_.surface.has_colors() ||
           !result_.position[0].empty() || !result_.vertex_color.planes.empty();
}

// Finishes a texel of the samples from `begin` to `end`.
void TransferStrips::finish_texel(Strip& strip, int i, int j, std::size_t begin, std::size_t end) const {
    if (begin == end) {
        result_.origin.at(i, j) = TexelOrigin::none;
        result_.map.x.at(i, j) = kNoNormal;
        return;
    }
    Hits hits;
    const std::size_t first_hit = strip.next_hit;
    for (std::size_t k = begin; k < end; ++k) {
        const RayEnd& ray = strip.ends[k];
        if (ray.behind) ++strip.behind;
        if (ray.triangle == kNoHit) continue;
        hits.normal = hits.normal + strip.normals.at(strip.next_hit++);
        hits.height += ray.height;
        ++hits.count;
    }
    ++strip.covered_texels;
    if (hits.count == 0) return miss_texel(strip, i, j, begin);
    result_.origin.at(i, j) = TexelOrigin::hit;
    const double part = 1.0 / hits.count;
    const auto height = static_cast<float>(part * hits.height);
    strip.heights.see(height);
    if (!result_.heights.empty()) result_.heights.at(i, j) = height;
    if (wants_more_) {
        see_more(strip, i, j, begin, end, first_hit);
        put_more(strip, i, j, part);
    }
    add_texel(strip, i, begin, end, hits);
}

// `hit` is the first of the texel.
void TransferStrips::see_more(Strip& strip, int i, int j, std::size_t begin, std::size_t end, std::size_t hit) const {
    More& more = strip.more;
    more.position = more.color = more.vertex_color = {};
    more.second = {};
    more.ids.clear();
    for (std::size_t k = begin; k < end; ++k) {
        const RayEnd& ray = strip.ends[k];
        if (ray.triangle == kNoHit) continue;
        const RayStart& from = strip.starts[k];
        const Triangles::Triangle& hit_triangle = strip.normals.triangle(hit);
        more.position = more.position + from.point + ray.height * from.direction;
        if (scene_.surface.has_colors()) more.color = more.color + scene_.surface.color_at(hit_triangle, ray.weights);
        if (!result_.vertex_color.planes.empty())
            more.vertex_color = more.vertex_color + HighSurface::vertex_color_at(hit_triangle, ray.weights);
        if (scene_.surface.has_ids()) more.ids.push_back(scene_.surface.id_of(hit_triangle));
        if (scene_.second != nullptr) see_second(strip, i, j, k, hit);
        ++hit;
    }
    strip.rays += more.second.rays;
}

void TransferStrips::see_second(Strip& strip, int i, int j, std::size_t k, std::size_t hit) const {
    const Triangles::Triangle& at = strip.normals.triangle(hit);
    HitPoint point{mix(at.corners(), strip.ends[k].weights), strip.normals.at(hit), HighSurface::face_normal(at)};
    if (scene_.backfaces && dot(point.face, strip.starts[k].direction) < 0.0) point.face = -1.0 * point.face;
    if (!(dot(point.normal, point.face) > 0.0)) point.normal = point.face;
    const std::uint32_t seed = Hemisphere::seed_of(i, j, static_cast<std::uint32_t>(strip.samples[k].place));
    scene_.second->add(point, seed, strip.scratch, strip.more.second);
}

// `part` is what each hit of the texel counts.
void TransferStrips::put_more(Strip& strip, int i, int j, double part) const {
    const More& more = strip.more;
    if (!result_.position[0].empty()) {
        result_.position[0].at(i, j) = static_cast<float>(part * more.position.x);
        result_.position[1].at(i, j) = static_cast<float>(part * more.position.y);
        result_.position[2].at(i, j) = static_cast<float>(part * more.position.z);
    }
    const SecondRays::Sums& second = more.second;
    if (!result_.occlusion.empty()) result_.occlusion.at(i, j) = static_cast<float>(part * second.open);
    if (!result_.thickness.empty()) {
        const auto thickness = static_cast<float>(second.thick == 0 ? 0.0 : second.thickness / second.thick);
        strip.thickness.see(thickness);
        result_.thickness.at(i, j) = thickness;
    }
    if (scene_.surface.has_ids()) result_.ids.at(i, j) = most_frequent(strip.more.ids);
    for (const auto& [image, sum] :
         {std::pair{&result_.color, &more.color}, std::pair{&result_.vertex_color, &more.vertex_color}}) {
        if (image->planes.empty()) continue;
        const double color[3] = {sum->x, sum->y, sum->z};
        for (std::size_t k = 0; k < 3; ++k) image->planes[k].at(i, j) = static_cast<float>(part * color[k]);
    }
}

void TransferStrips::miss_texel(Strip& strip, int i, int j, std::size_t begin) const {
    result_.origin.at(i, j) = TexelOrigin::missed;
    result_.map.x.at(i, j) = kNoNormal;
    ++strip.missed;
    const int group = strip.samples[begin].group;
    const RayEnd line = group == RayGroups::kNone ? RayEnd{}
                                                  : scene_.casters[static_cast<std::size_t>(group)].cast_line(
                                                        strip.starts[begin], strip.casts.work);
    if (line.triangle == kNoHit)
        ++strip.hopeless;
    else
        strip.needs.push_back(static_cast<float>(line.height));
}

// It gets the tangent space at its centre, on the triangle of the sample that is nearest to it.
void TransferStrips::add_texel(Strip& strip, int i, std::size_t begin, std::size_t end, const Hits& hits) const {
    std::size_t nearest = begin;
    double least = std::numeric_limits<double>::infinity(), x = 0.0, y = 0.0;
    for (std::size_t k = begin; k < end && n_ > 1; ++k) {
        const auto place = static_cast<int>(strip.samples[k].place);
        const double dx = 0.5 - (place % n_ + 0.5) / n_, dy = 0.5 - (place / n_ + 0.5) / n_,
                     squared = dx * dx + dy * dy;
        if (squared >= least) continue;
        nearest = k;
        least = squared;
        x = dx;
        y = dy;
    }
    const std::int32_t triangle = strip.samples[nearest].triangle;
    Texels& texels = strip.texels;
    const std::size_t next = texels.count++;
    texels.list[next] = {i, triangle};
    std::array<double, 3> weights = strip.weights.at(nearest);
    if (n_ > 1) weights = triangle_of(strip, triangle).moved(weights, x, y);
    texels.weights.set(next, weights[0], weights[1], weights[2]);
    texels.normals.set(next, hits.normal.x, hits.normal.y, hits.normal.z);
    if (!result_.bent.x.empty()) texels.bent.push_back(strip.more.second.bent);
}

void TransferStrips::encode_texels(Strip& strip, int j) const {
    Texels& texels = strip.texels;
    const auto& list = texels.list;
    for (std::size_t first = 0, end = 0; first < texels.count; first = end) {
        for (end = first; end < texels.count && list[end].triangle == list[first].triangle;) ++end;
        const CornerFrames& frames = triangle_of(strip, list[first].triangle).frames();
        const EncodedCounts counts = encode_vectors(
            frames.corners(), texels.weights.all().from(first), texels.normals.all().from(first), end - first,
            texels.units.all().from(first), {texels.x + first, texels.y + first, texels.z + first});
        strip.singular += static_cast<std::int64_t>(counts.singular);
        strip.backward += static_cast<std::int64_t>(counts.backward);
        for (std::size_t k = first; k < end && !texels.bent.empty(); ++k) {
            const Vector3& sum = texels.bent[k];
            const Vector3 bent = dot(sum, sum) > 1e-12 ? normalized(sum) : vector_of(texels.units.at(k));
            const Frame frame = frames.at(texels.weights.at(k));
            put(result_.bent, list[k].i, j, encode(frame, bent).value_or(Vector3{0.0, 0.0, 1.0}));
        }
    }
    for (std::size_t k = 0; k < texels.count; ++k) {
        const int i = list[k].i;
        result_.map.x.at(i, j) = texels.x[k];
        result_.map.y.at(i, j) = texels.y[k];
        result_.map.z.at(i, j) = texels.z[k];
        if (!result_.object.x.empty()) put(result_.object, i, j, vector_of(texels.units.at(k)));
    }
}

}  // namespace tex::inline v1
