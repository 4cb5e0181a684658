// SPDX-License-Identifier: Apache-2.0

#include "rays/transfer_strips.h"

#include <cmath>
#include <optional>
#include <utility>

#include "mesh/frames.h"

namespace tex::inline v1 {
namespace {

// Rays that are cast at once.
constexpr int kRaysAtOnce = 512;
// The part of the missed texels whose need is reported.
constexpr double kMostMissed = 0.95;

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

}  // namespace

void put(NormalMap& map, int i, int j, Vector3 n) {
    map.x.at(i, j) = static_cast<float>(n.x);
    map.y.at(i, j) = static_cast<float>(n.y);
    map.z.at(i, j) = static_cast<float>(n.z);
}

const LowTriangle& TransferStrips::triangle_of(Strip& strip, const Covered& covered) const {
    Kept& kept = strip.kept[static_cast<std::size_t>(covered.triangle) % kKept];
    if (covered.triangle != kept.number) {
        kept.number = covered.triangle;
        kept.triangle = LowTriangle(scene_.low, static_cast<std::size_t>(covered.triangle), result_.map.extent());
    }
    return kept.triangle;
}

void TransferStrips::run(int strip) {
    std::unique_ptr<Strip> work = take_strip();
    const std::int64_t overlaps = scene_.coverage.cover(strip, work->covered);
    const Extent extent = result_.map.extent();
    const int rows = scene_.coverage.strip_rows() / n_, first = strip * rows;
    const int width = std::max(1, kRaysAtOnce / (n_ * n_));
    for (int j = first; j < std::min(extent.height, first + rows); ++j) {
        for (int i = 0; i < extent.width; i += width) cast(*work, first, j, i, std::min(extent.width, i + width));
    }
    add(std::move(work), overlaps);
}

std::unique_ptr<TransferStrips::Strip> TransferStrips::take_strip() {
    const std::lock_guard lock(mutex_);
    if (idle_.empty()) return std::make_unique<Strip>();
    std::unique_ptr<Strip> strip = std::move(idle_.back());
    idle_.pop_back();
    return strip;
}

void TransferStrips::add(std::unique_ptr<Strip> strip, std::int64_t overlaps) {
    const Found& found = *strip;
    const std::lock_guard lock(mutex_);
    result_.overlaps += overlaps;
    result_.covered += found.covered_texels;
    result_.missed += found.missed;
    result_.backward += found.backward;
    result_.singular += found.singular;
    result_.behind += found.behind;
    result_.hopeless += found.hopeless;
    result_.rays += found.rays;
    for (const auto& [sum, part] : {std::pair{&heights_, &found.heights}, {&thickness_, &found.thickness}}) {
        sum->lowest = std::min(sum->lowest, part->lowest);
        sum->highest = std::max(sum->highest, part->highest);
    }
    needs_.insert(needs_.end(), found.needs.begin(), found.needs.end());
    static_cast<Found&>(*strip) = {};
    idle_.push_back(std::move(strip));
}

void TransferStrips::finish() {
    if (!heights_.is_empty()) {
        result_.lowest = heights_.lowest;
        result_.highest = heights_.highest;
    }
    if (!thickness_.is_empty()) {
        result_.thinnest = thickness_.lowest;
        result_.thickest = thickness_.highest;
    }
    const auto nearer = [](float a, float b) { return std::abs(a) < std::abs(b) || (a == -b && a < b); };
    std::sort(needs_.begin(), needs_.end(), nearer);
    const auto most = static_cast<std::size_t>(std::ceil(kMostMissed * static_cast<double>(needs_.size())));
    for (std::size_t k = 0; k < most; ++k) {
        const auto need = static_cast<double>(needs_[k]);
        result_.needed_front = std::max(result_.needed_front, need);
        result_.needed_back = std::max(result_.needed_back, -need);
    }
}

// Some texels of row j.
void TransferStrips::cast(Strip& strip, int first_row, int j, int begin, int end) const {
    collect(strip, first_row, j, begin, end);
    cast_groups(strip);
    const std::int64_t before = strip.rays;
    strip.rays += static_cast<std::int64_t>(strip.starts.size());
    std::size_t first = 0;
    for (int i = begin; i < end; ++i) {
        std::size_t last = first;
        while (last < strip.samples.size() && strip.samples[last].i == i) ++last;
        finish_texel(strip, i, j, first, last);
        first = last;
    }
    if (scene_.rays != nullptr) scene_.rays->fetch_add(strip.rays - before, std::memory_order_relaxed);
}

// The covered samples, and where their rays start.
void TransferStrips::collect(Strip& strip, int first_row, int j, int begin, int end) const {
    const auto n = static_cast<std::size_t>(n_);
    const auto [map_width, map_height] = result_.map.extent();
    const std::size_t width = static_cast<std::size_t>(map_width) * n;
    strip.samples.clear();
    strip.starts.clear();
    const Covered* const top = strip.covered.data() + static_cast<std::size_t>(j - first_row) * n * width;
    for (int i = begin; i < end; ++i) {
        for (std::size_t row = 0, k = 0; row < n; ++row) {
            for (std::size_t column = 0; column < n; ++column, ++k) {
                const Covered& covered = top[row * width + static_cast<std::size_t>(i) * n + column];
                if (!covered.inside) continue;
                const auto triangle = static_cast<std::size_t>(covered.triangle);
                const Vector3 point = triangle_of(strip, covered).point(covered.weights);
                double x = 0.0, y = 0.0;
                if (scene_.starts.has_pictures()) {
                    x = (i + (static_cast<double>(column) + 0.5) / n_) / map_width;
                    y = (j + (static_cast<double>(row) + 0.5) / n_) / map_height;
                }
                strip.samples.push_back({i, k, covered, scene_.groups.of_low(triangle)});
                strip.starts.push_back(scene_.starts.at(triangle, covered.weights, point, x, y));
            }
        }
    }
}

void TransferStrips::cast_groups(Strip& strip) const {
    if (scene_.casters.size() == 1 && scene_.groups.has_all())
        return scene_.casters.front().cast(strip.starts, strip.ends, strip.casts);
    strip.ends.assign(strip.starts.size(), {});
    for (std::size_t group = 0; group < scene_.casters.size(); ++group) {
        strip.chosen.clear();
        strip.chosen_starts.clear();
        for (std::size_t k = 0; k < strip.samples.size(); ++k) {
            if (strip.samples[k].group != static_cast<int>(group)) continue;
            strip.chosen.push_back(k);
            strip.chosen_starts.push_back(strip.starts[k]);
        }
        if (strip.chosen.empty()) continue;
        scene_.casters[group].cast(strip.chosen_starts, strip.chosen_ends, strip.casts);
        for (std::size_t k = 0; k < strip.chosen.size(); ++k) strip.ends[strip.chosen[k]] = strip.chosen_ends[k];
    }
}

// Of the samples from `begin` to `end`.
void TransferStrips::finish_texel(Strip& strip, int i, int j, std::size_t begin, std::size_t end) const {
    if (begin == end) {
        result_.origin.at(i, j) = TexelOrigin::none;
        result_.map.x.at(i, j) = kNoNormal;
        return;
    }
    Hits hits;
    strip.ids.clear();
    for (std::size_t k = begin; k < end; ++k) {
        if (strip.ends[k].behind) ++strip.behind;
        if (strip.ends[k].triangle != kNoHit) add_hit(strip, i, j, k, hits);
    }
    ++strip.covered_texels;
    strip.rays += hits.second.rays;
    if (hits.count == 0) return miss_texel(strip, i, j, begin);
    result_.origin.at(i, j) = TexelOrigin::hit;
    put_values(strip, i, j, hits);
    put_surface(strip, i, j, hits);
    encode_texel(strip, i, j, begin, end, hits);
}

void TransferStrips::add_hit(Strip& strip, int i, int j, std::size_t k, Hits& hits) const {
    const RayEnd& ray = strip.ends[k];
    const RayStart& from = strip.starts[k];
    const Sample& sample = strip.samples[k];
    const RayCaster& caster = scene_.casters[static_cast<std::size_t>(sample.group)];
    const Triangles::Place hit = caster.place_of(ray);
    const Vector3 normal = scene_.surface.normal_at(hit, ray.weights, strip.seen);
    hits.normal = hits.normal + normal;
    hits.position = hits.position + from.point + ray.height * from.direction;
    hits.height += ray.height;
    ++hits.count;
    if (scene_.surface.has_colors()) hits.color = hits.color + scene_.surface.color_at(hit, ray.weights);
    if (!result_.vertex_color.planes.empty())
        hits.vertex_color = hits.vertex_color + HighSurface::vertex_color_at(hit, ray.weights);
    if (scene_.surface.has_ids()) strip.ids.push_back(scene_.surface.id_of(hit));
    if (scene_.second == nullptr) return;
    HitPlace place{caster.point_of(ray), normal, HighSurface::face_normal(hit)};
    if (scene_.backfaces && dot(place.face, from.direction) < 0.0) {
        place.face = -1.0 * place.face;
        place.normal = -1.0 * place.normal;
    }
    if (!(dot(place.normal, place.face) > 0.0)) place.normal = place.face;
    const std::uint32_t seed = Hemisphere::seed_of(i, j, static_cast<std::uint32_t>(sample.place));
    scene_.second->add(place, seed, strip.scratch, hits.second);
}

void TransferStrips::put_values(Strip& strip, int i, int j, const Hits& hits) const {
    const double part = 1.0 / hits.count;
    const auto height = static_cast<float>(part * hits.height);
    strip.heights.see(height);
    if (!result_.heights.empty()) result_.heights.at(i, j) = height;
    if (!result_.position[0].empty()) {
        result_.position[0].at(i, j) = static_cast<float>(part * hits.position.x);
        result_.position[1].at(i, j) = static_cast<float>(part * hits.position.y);
        result_.position[2].at(i, j) = static_cast<float>(part * hits.position.z);
    }
    const SecondRays::Sums& second = hits.second;
    if (!result_.occlusion.empty()) result_.occlusion.at(i, j) = static_cast<float>(part * second.open);
    if (!result_.thickness.empty()) {
        const auto thickness = static_cast<float>(second.thick == 0 ? 0.0 : second.thickness / second.thick);
        strip.thickness.see(thickness);
        result_.thickness.at(i, j) = thickness;
    }
}

void TransferStrips::put_surface(Strip& strip, int i, int j, const Hits& hits) const {
    if (scene_.surface.has_ids()) result_.ids.at(i, j) = most_frequent(strip.ids);
    const double part = 1.0 / hits.count;
    for (const auto& [image, sum] :
         {std::pair{&result_.color, &hits.color}, std::pair{&result_.vertex_color, &hits.vertex_color}}) {
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
    const RayEnd line = group == RayGroups::kNone
                            ? RayEnd{}
                            : scene_.casters[static_cast<std::size_t>(group)].cast_line(strip.starts[begin]);
    if (line.triangle == kNoHit)
        ++strip.hopeless;
    else
        strip.needs.push_back(static_cast<float>(line.height));
}

// In the tangent space at the centre of the texel, on the triangle of the sample that is nearest to it.
void TransferStrips::encode_texel(Strip& strip, int i, int j, std::size_t begin, std::size_t end,
                                  const Hits& hits) const {
    const Sample* nearest = &strip.samples[begin];
    double least = std::numeric_limits<double>::infinity(), x = 0.0, y = 0.0;
    for (std::size_t k = begin; k < end && n_ > 1; ++k) {
        const auto place = static_cast<int>(strip.samples[k].place);
        const double dx = 0.5 - (place % n_ + 0.5) / n_, dy = 0.5 - (place / n_ + 0.5) / n_,
                     squared = dx * dx + dy * dy;
        if (squared >= least) continue;
        nearest = &strip.samples[k];
        least = squared;
        x = dx;
        y = dy;
    }
    const Frame frame = triangle_of(strip, nearest->covered).frame(nearest->covered.weights, x, y);
    const Vector3 n = normalized(hits.normal);
    const std::optional<Vector3> t = encode(frame, n);
    if (!t) ++strip.singular;
    if (t && t->z < 0.0) ++strip.backward;
    const Vector3 flat{0.0, 0.0, 1.0};
    put(result_.map, i, j, t.value_or(flat));
    if (!result_.object.x.empty()) put(result_.object, i, j, n);
    if (result_.bent.x.empty()) return;
    const Vector3 bent = dot(hits.second.bent, hits.second.bent) > 1e-12 ? normalized(hits.second.bent) : n;
    put(result_.bent, i, j, encode(frame, bent).value_or(flat));
}

}  // namespace tex::inline v1
