// SPDX-License-Identifier: Apache-2.0

#include "rays/transfer_strips.h"

#include <cmath>
#include <utility>

namespace tex::inline v1 {
namespace {

// The part of the missed texels whose need is reported.
constexpr double kMostMissed = 0.95;

}  // namespace

const LowTriangle& TransferStrips::triangle_of(Strip& strip, std::int32_t number) const {
    CachedTriangle& kept = strip.kept[static_cast<std::size_t>(number) % kCachedTriangles];
    if (number != kept.number) {
        kept.number = number;
        kept.triangle = LowTriangle(scene_.low, static_cast<std::size_t>(number), result_.map.extent());
    }
    return kept.triangle;
}

void TransferStrips::run(int strip) {
    if (costly_.is_before(strip)) return;
    std::unique_ptr<Strip> work = take_strip();
    const Overlaps overlaps = scene_.coverage.cover(strip, work->covered);
    const Extent extent = result_.map.extent();
    const int rows = scene_.coverage.strip_rows() / n_, first = strip * rows;
    const int width = std::max(1, static_cast<int>(kRaysAtOnce) / (n_ * n_));
    for (int j = first; j < std::min(extent.height, first + rows); ++j) {
        for (int i = 0; i < extent.width; i += width) {
            const auto costly = cast(*work, first, j, i, std::min(extent.width, i + width));
            if (costly) return costly_.see(strip, *costly);
        }
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

void TransferStrips::add(std::unique_ptr<Strip> strip, const Overlaps& overlaps) {
    const Found& found = *strip;
    const std::lock_guard lock(mutex_);
    result_.overlaps += overlaps.same;
    result_.moved += overlaps.moved;
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
std::optional<RaySide> TransferStrips::cast(Strip& strip, int first_row, int j, int begin, int end) const {
    strip.starting = strip.casts.work = strip.scratch.work = {};
    collect(strip, first_row, j, begin, end);
    start_rays(strip, j);
    if (!strip.starting.is_fair()) return RaySide::low;
    cast_groups(strip);
    if (!strip.casts.work.is_fair()) return RaySide::high;
    find_normals(strip);
    const std::int64_t before = strip.rays;
    strip.rays += static_cast<std::int64_t>(strip.starts.size());
    strip.texels.count = 0;
    strip.texels.bent.clear();
    std::size_t first = 0;
    for (int i = begin; i < end; ++i) {
        std::size_t last = first;
        while (last < strip.samples.size() && strip.samples[last].i == i) ++last;
        finish_texel(strip, i, j, first, last);
        first = last;
    }
    if (!strip.casts.work.is_fair() || !strip.scratch.work.is_fair()) return RaySide::high;
    encode_texels(strip, j);
    if (scene_.rays != nullptr) scene_.rays->fetch_add(strip.rays - before, std::memory_order_relaxed);
    return std::nullopt;
}

void TransferStrips::collect(Strip& strip, int first_row, int j, int begin, int end) const {
    const auto n = static_cast<std::size_t>(n_);
    const std::size_t width = static_cast<std::size_t>(result_.map.extent().width) * n;
    strip.samples.clear();
    const Covered* const top = strip.covered.data() + static_cast<std::size_t>(j - first_row) * n * width;
    for (int i = begin; i < end; ++i) {
        for (std::size_t row = 0, k = 0; row < n; ++row) {
            for (std::size_t column = 0; column < n; ++column, ++k) {
                const Covered& covered = top[row * width + static_cast<std::size_t>(i) * n + column];
                if (!covered.inside) continue;
                const std::size_t next = strip.samples.size();
                strip.weights.set(next, covered.weights[0], covered.weights[1], covered.weights[2]);
                const int group = scene_.groups.of_low(static_cast<std::size_t>(covered.triangle));
                strip.samples.push_back({i, covered.triangle, k, group});
            }
        }
    }
}

// Where the rays of the samples start. Samples of a triangle follow each other.
void TransferStrips::start_rays(Strip& strip, int j) const {
    const std::vector<Sample>& samples = strip.samples;
    const auto [width, height] = result_.map.extent();
    strip.starts.resize(samples.size());
    for (std::size_t first = 0, end = 0; first < samples.size(); first = end) {
        const std::int32_t number = samples[first].triangle;
        for (end = first; end < samples.size() && samples[end].triangle == number;) ++end;
        const auto triangle = static_cast<std::size_t>(number);
        const auto weights = strip.weights.all().from(first), points = strip.points.all().from(first);
        triangle_of(strip, number).points(weights, end - first, points);
        if (!scene_.starts.has_pictures()) {
            scene_.starts.along(triangle, weights, points, end - first, strip.directions.all().from(first),
                                strip.starts.data() + first, strip.starting);
            continue;
        }
        for (std::size_t k = first; k < end; ++k) {
            const auto place = static_cast<int>(samples[k].place);
            const double x = (samples[k].i + (place % n_ + 0.5) / n_) / width,
                         y = (j + (place / n_ + 0.5) / n_) / height;
            strip.starts[k] =
                scene_.starts.at(triangle, strip.weights.at(k), vector_of(strip.points.at(k)), x, y, strip.starting);
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

void TransferStrips::find_normals(Strip& strip) const {
    strip.normals.clear();
    strip.next_hit = 0;
    for (std::size_t k = 0; k < strip.samples.size(); ++k) {
        const RayEnd& ray = strip.ends[k];
        if (ray.triangle == kNoHit) continue;
        const RayCaster& caster = scene_.casters[static_cast<std::size_t>(strip.samples[k].group)];
        strip.normals.add(scene_.surface, caster.place_of(ray), ray.weights);
    }
    strip.normals.find(scene_.surface);
    if (!scene_.backfaces) return;
    std::size_t hit = 0;
    for (const RayEnd& ray : strip.ends) {
        if (ray.triangle == kNoHit) continue;
        if (ray.behind) strip.normals.turn(hit, HighSurface::face_normal(strip.normals.triangle(hit)));
        ++hit;
    }
}

}  // namespace tex::inline v1
