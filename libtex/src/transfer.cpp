// SPDX-License-Identifier: Apache-2.0

#include <tex/transfer.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "mesh/coverage.h"
#include "mesh/frames.h"
#include "rays/found_reach.h"
#include "rays/low_triangle.h"
#include "rays/ray_casts.h"
#include "rows/usable.h"
#include "surface/nearest.h"
#include "threads/guard.h"
#include "threads/parallel.h"

namespace tex {
namespace {

// Rays that are cast at once.
constexpr int kRaysAtOnce = 2048;
// The part of the missed texels whose need is reported.
constexpr double kMostMissed = 0.95;

// In NormalMap::x, marks texels that have no normal yet.
constexpr float kNoNormal = std::numeric_limits<float>::quiet_NaN();

void put(NormalMap& map, int i, int j, Vector3 n) {
    map.x.at(i, j) = static_cast<float>(n.x);
    map.y.at(i, j) = static_cast<float>(n.y);
    map.z.at(i, j) = static_cast<float>(n.z);
}

double diagonal_of(const MeshPart& part) {
    Vector3 low = vector_of(part.positions[part.indices.front()]), high = low;
    for (const std::uint32_t v : part.indices) {
        const Vector3 p = vector_of(part.positions[v]);
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    return std::sqrt(dot(high - low, high - low));
}

double length_of(const Reach& reach, double diagonal, double automatic) {
    switch (reach.unit) {
        case Reach::Unit::absolute: return reach.value;
        case Reach::Unit::percent: return reach.value / 100.0 * diagonal;
        case Reach::Unit::automatic: break;
    }
    return automatic;
}

// A covered sample of a texel.
struct Sample {
    int i;
    std::size_t place;  // among the n x n samples of its texel
    Covered covered;
};

// Casts the rays of strips of rows, without the padding. The coverage is that of samples.
class StripTransfer {
public:
    StripTransfer(const TangentSpace& low, const RayDirections& directions, const RayCaster& caster,
                  const CoverageMap& coverage, int subsamples, TransferredMaps& result)
        : low_(low), directions_(directions), caster_(caster), coverage_(coverage), n_(subsamples), result_(result) {}

    // Threads may transfer different strips at the same time.
    void run(int strip);
    // The needs of missed texels, as heights of what would have hit them.
    void finish();

private:
    struct Strip {
        std::vector<Covered> covered;  // of samples
        std::vector<Sample> samples;
        std::vector<RayStart> starts;
        std::vector<RayEnd> ends;
        std::int32_t number = kNoTriangle;  // of `triangle`
        LowTriangle triangle;
        std::int64_t covered_texels = 0, missed = 0, backward = 0, singular = 0, behind = 0, hopeless = 0;
        float lowest = std::numeric_limits<float>::infinity(), highest = -std::numeric_limits<float>::infinity();
        std::vector<float> needs;
    };

    const LowTriangle& triangle_of(Strip& strip, const Covered& covered) const {
        if (covered.triangle != strip.number) {
            strip.number = covered.triangle;
            strip.triangle = LowTriangle(low_, static_cast<std::size_t>(covered.triangle), result_.map.extent());
        }
        return strip.triangle;
    }
    void cast(Strip& strip, int first_row, int j, int begin, int end) const;
    void finish_texel(Strip& strip, int i, int j, std::size_t begin, std::size_t end) const;
    void miss_texel(Strip& strip, int i, int j, std::size_t begin) const;
    void encode_texel(Strip& strip, int i, int j, std::size_t begin, std::size_t end, Vector3 n) const;
    void add(Strip& strip, std::int64_t overlaps);

    const TangentSpace& low_;
    const RayDirections& directions_;
    const RayCaster& caster_;
    const CoverageMap& coverage_;
    const int n_;
    TransferredMaps& result_;
    std::mutex mutex_;  // guards the counts in result_, and:
    std::vector<float> needs_;
    float lowest_ = std::numeric_limits<float>::infinity(), highest_ = -std::numeric_limits<float>::infinity();
};

void StripTransfer::run(int strip) {
    Strip work;
    const std::int64_t overlaps = coverage_.cover(strip, work.covered);
    const Extent extent = result_.map.extent();
    const int rows = coverage_.strip_rows() / n_, first = strip * rows;
    const int width = std::max(1, kRaysAtOnce / (n_ * n_));
    for (int j = first; j < std::min(extent.height, first + rows); ++j) {
        for (int i = 0; i < extent.width; i += width) cast(work, first, j, i, std::min(extent.width, i + width));
    }
    add(work, overlaps);
}

void StripTransfer::add(Strip& strip, std::int64_t overlaps) {
    const std::lock_guard lock(mutex_);
    result_.overlaps += overlaps;
    result_.covered += strip.covered_texels;
    result_.missed += strip.missed;
    result_.backward += strip.backward;
    result_.singular += strip.singular;
    result_.behind += strip.behind;
    result_.hopeless += strip.hopeless;
    lowest_ = std::min(lowest_, strip.lowest);
    highest_ = std::max(highest_, strip.highest);
    needs_.insert(needs_.end(), strip.needs.begin(), strip.needs.end());
}

void StripTransfer::finish() {
    if (result_.covered == result_.missed) return;
    result_.lowest = lowest_;
    result_.highest = highest_;
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
void StripTransfer::cast(Strip& strip, int first_row, int j, int begin, int end) const {
    const auto n = static_cast<std::size_t>(n_);
    const std::size_t width = static_cast<std::size_t>(result_.map.extent().width) * n;
    strip.samples.clear();
    strip.starts.clear();
    for (int i = begin; i < end; ++i) {
        for (std::size_t k = 0; k < n * n; ++k) {
            const Covered& covered = strip.covered[(static_cast<std::size_t>(j - first_row) * n + k / n) * width +
                                                   static_cast<std::size_t>(i) * n + k % n];
            if (!covered.inside) continue;
            const Vector3 point = triangle_of(strip, covered).point(covered.weights);
            strip.samples.push_back({i, k, covered});
            strip.starts.push_back(
                {point, directions_.at(static_cast<std::size_t>(covered.triangle), covered.weights, point)});
        }
    }
    caster_.cast(strip.starts, strip.ends);
    std::size_t first = 0;
    for (int i = begin; i < end; ++i) {
        std::size_t last = first;
        while (last < strip.samples.size() && strip.samples[last].i == i) ++last;
        finish_texel(strip, i, j, first, last);
        first = last;
    }
}

// Of the samples from `begin` to `end`.
void StripTransfer::finish_texel(Strip& strip, int i, int j, std::size_t begin, std::size_t end) const {
    Vector3 normal, position;
    double height = 0.0;
    int hits = 0;
    for (std::size_t k = begin; k < end; ++k) {
        const RayEnd& ray = strip.ends[k];
        if (ray.behind) ++strip.behind;
        if (ray.triangle == kNoHit) continue;
        normal = normal + caster_.normal_at(ray);
        position = position + strip.starts[k].point + ray.height * strip.starts[k].direction;
        height += ray.height;
        ++hits;
    }
    if (begin == end) {
        result_.origin.at(i, j) = TexelOrigin::none;
        result_.map.x.at(i, j) = kNoNormal;
        return;
    }
    ++strip.covered_texels;
    if (hits == 0) return miss_texel(strip, i, j, begin);
    result_.origin.at(i, j) = TexelOrigin::hit;
    const double part = 1.0 / hits;
    const auto mean = static_cast<float>(part * height);
    strip.lowest = std::min(strip.lowest, mean);
    strip.highest = std::max(strip.highest, mean);
    if (!result_.heights.empty()) result_.heights.at(i, j) = mean;
    if (!result_.position[0].empty()) {
        result_.position[0].at(i, j) = static_cast<float>(part * position.x);
        result_.position[1].at(i, j) = static_cast<float>(part * position.y);
        result_.position[2].at(i, j) = static_cast<float>(part * position.z);
    }
    encode_texel(strip, i, j, begin, end, normalized(normal));
}

void StripTransfer::miss_texel(Strip& strip, int i, int j, std::size_t begin) const {
    result_.origin.at(i, j) = TexelOrigin::missed;
    result_.map.x.at(i, j) = kNoNormal;
    ++strip.missed;
    const RayEnd line = caster_.cast_line(strip.starts[begin]);
    if (line.triangle == kNoHit)
        ++strip.hopeless;
    else
        strip.needs.push_back(static_cast<float>(line.height));
}

// In the tangent space at the centre of the texel, on the triangle of the sample that is nearest to it.
void StripTransfer::encode_texel(Strip& strip, int i, int j, std::size_t begin, std::size_t end, Vector3 n) const {
    const Sample* nearest = nullptr;
    double least = 0.0, x = 0.0, y = 0.0;
    for (std::size_t k = begin; k < end; ++k) {
        const auto column = static_cast<double>(strip.samples[k].place % static_cast<std::size_t>(n_)),
                   row = static_cast<double>(strip.samples[k].place / static_cast<std::size_t>(n_));
        const double dx = 0.5 - (column + 0.5) / n_, dy = 0.5 - (row + 0.5) / n_, squared = dx * dx + dy * dy;
        if (nearest != nullptr && squared >= least) continue;
        nearest = &strip.samples[k];
        least = squared;
        x = dx;
        y = dy;
    }
    const Frame frame = triangle_of(strip, nearest->covered).frame(nearest->covered.weights, x, y);
    const std::optional<Vector3> t = encode(frame, n);
    if (!t) ++strip.singular;
    if (t && t->z < 0.0) ++strip.backward;
    put(result_.map, i, j, t.value_or(Vector3{0.0, 0.0, 1.0}));
    if (!result_.object.x.empty()) put(result_.object, i, j, n);
}

// Fills missed texels and the padding from the nearest texel with a hit. The others become background.
Result<void> fill_rest(TransferredMaps& result, std::int64_t width, const Execution& execution, ProgressSpan span) {
    const bool objects = !result.object.x.empty();
    std::vector<Plane<float>*> planes = {&result.map.x, &result.map.y, &result.map.z};
    if (objects) planes.insert(planes.end(), {&result.object.x, &result.object.y, &result.object.z});
    std::vector<Plane<float>*> others;
    if (!result.heights.empty()) others.push_back(&result.heights);
    for (Plane<float>& plane : result.position) {
        if (!plane.empty()) others.push_back(&plane);
    }
    const auto fill = [&](const NearestTexel& hole) {
        TexelOrigin& origin = result.origin.at(hole.i, hole.j);
        if (origin == TexelOrigin::none && hole.squared > width * width) {
            put(result.map, hole.i, hole.j, {0.0, 0.0, 1.0});
            if (objects) put(result.object, hole.i, hole.j, {0.0, 0.0, 1.0});
            for (Plane<float>* plane : others) plane->at(hole.i, hole.j) = 0.0f;
            return;
        }
        if (origin == TexelOrigin::none) origin = TexelOrigin::padding;
        for (Plane<float>* plane : planes) plane->at(hole.i, hole.j) = plane->at(hole.column, hole.row);
        for (Plane<float>* plane : others) plane->at(hole.i, hole.j) = plane->at(hole.column, hole.row);
    };
    return visit_holes(result.map.x.view(), Wrap::repeat, Wrap::repeat, execution, span, fill);
}

std::string plain(double value) {
    char text[32];
    return {text, std::to_chars(text, text + sizeof text, value, std::chars_format::general, 4).ptr};
}

Error no_hit(const TangentSpace& low, const BoxTree& tree, const TransferredMaps& result) {
    const std::string reach = "rays reach " + plain(result.front) + " in front and " + plain(result.back) + " behind";
    const double distance = distance_between(low.part, tree);
    if (distance > std::max(result.front, result.back)) {
        return {ErrorCode::bad_option, low.file,
                "no ray hits the high mesh, which is " + plain(distance) + " away, while " + reach +
                    ": both must be in the same place and unit"};
    }
    return {ErrorCode::bad_option, low.file,
            "no ray hits the high mesh from outside, while " + reach +
                ": rays must reach farther, or its triangles face the other way"};
}

Result<TransferredMaps> cast_all(Extent extent, const TangentSpace& low, const std::vector<MeshPart>& high,
                                 const TransferOptions& options, const Execution& execution) {
    std::vector<const MeshPart*> parts;
    std::size_t count = 0;
    for (const MeshPart& part : high) {
        parts.push_back(&part);
        count += part.triangles();
    }
    if (count == 0) return Error{ErrorCode::bad_option, {}, "the high mesh is empty"};
    if (count > kMaxTriangles) return Error{ErrorCode::unsupported, {}, "the high mesh has more than 2^28 triangles"};
    const Triangles triangles(std::move(parts));
    const auto tree = BoxTree::build(triangles, execution, {0.0, 0.1});
    if (!tree) return tree.error();

    TransferredMaps result;
    result.diagonal = diagonal_of(low.part);
    const double width = length_of(options.straight_width, result.diagonal, 0.05 * result.diagonal);
    const auto directions = RayDirections::make(low.part, options.rays, width, options.straight_angle, execution);
    if (!directions) return directions.error();
    FoundReach found;
    if (options.front.unit == Reach::Unit::automatic || options.back.unit == Reach::Unit::automatic) {
        const auto reach = found_reach(low.part, *directions, triangles, *tree, result.diagonal, execution);
        if (!reach) return reach.error();
        found = *reach;
    }
    result.front = length_of(options.front, result.diagonal, found.front);
    result.back = length_of(options.back, result.diagonal, found.back);

    const int n = options.subsamples;
    const auto coverage = CoverageMap::make(low.part, low.uv_set, {extent.width * n, extent.height * n}, 0, n);
    if (!coverage) return coverage.error().of(low.file);
    result.map = NormalMap(extent);
    result.origin = Plane<TexelOrigin>(extent);
    if (options.object) result.object = NormalMap(extent);
    if (options.heights) result.heights = Plane<float>(extent);
    for (Plane<float>& plane : result.position) {
        if (options.positions) plane = Plane<float>(extent);
    }
    const RayCaster caster(triangles, *tree, options.hit, options.backfaces, result.front, result.back);
    StripTransfer strips(low, *directions, caster, *coverage, n, result);
    const auto run = [&](int begin, int end) {
        for (int strip = begin; strip < end; ++strip) strips.run(strip);
    };
    if (auto done = parallel_for(execution, coverage->strips(), 1, run, {0.1, 0.9}); !done) return done.error();
    strips.finish();
    if (result.covered == 0) return Error{ErrorCode::bad_option, low.file, "its triangles cover no texel of the map"};
    if (result.covered == result.missed) return no_hit(low, *tree, result);
    return result;
}

}  // namespace

Result<void> validate(const TransferOptions& options) {
    const auto is_length = [](const Reach& reach) {
        return reach.unit == Reach::Unit::automatic || (reach.value >= 0.0 && std::isfinite(reach.value));
    };
    if (!is_length(options.front)) return bad_option("front: must be 0 or more");
    if (!is_length(options.back)) return bad_option("back: must be 0 or more");
    if (!is_length(options.straight_width)) return bad_option("straight_width: must be 0 or more");
    if (!(options.straight_angle >= 0.0 && options.straight_angle <= 180.0))
        return bad_option("straight_angle: must be from 0 to 180");
    if (options.padding < 0) return bad_option("padding: must be 0 or more");
    if (options.subsamples < 1 || options.subsamples > kMaxSubsamples)
        return bad_option("subsamples: must be from 1 to 8");
    return {};
}

Result<TransferredMaps> transfer(Extent extent, const TangentSpace& low, const std::vector<MeshPart>& high,
                                 const TransferOptions& options, const Execution& execution) {
    return guarded([&]() -> Result<TransferredMaps> {
        if (auto usable = check_usable(extent, "the map"); !usable) return usable.error();
        if (auto valid = validate(options); !valid) return valid.error();
        if (auto sound = check_part(low.part); !sound) return sound.error().of(low.file);
        for (const MeshPart& part : high) {
            if (auto sound = check_part(part); !sound) return sound.error();
        }
        if (const auto checked = check_space(low); !checked) return checked.error().of(low.file);
        auto result = cast_all(extent, low, high, options, execution);
        if (!result) return result;
        const std::int64_t width = std::min(options.padding, 2 * kMaxExtent);
        if (auto filled = fill_rest(*result, width, execution, {0.9, 1.0}); !filled) return filled.error();
        return result;
    });
}

}  // namespace tex
