// SPDX-License-Identifier: Apache-2.0

#include <tex/mesh.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "fields/field_check.h"
#include "fields/mesh_fields.h"
#include "mesh/coverage.h"
#include "mesh/frames.h"
#include "rows/extra_rows.h"
#include "rows/usable.h"
#include "surface/nearest.h"
#include "threads/no_throw.h"
#include "threads/parallel.h"

namespace tex::inline v1 {
namespace {

// The width in texels of the border that continues triangles in object space.
constexpr int kGutter = 2;

// In NormalMap::x, marks texels that have no normal yet.
constexpr float kHole = std::numeric_limits<float>::quiet_NaN();

enum class Direction { to_object, to_tangent };

void set(NormalMap& map, int i, int j, Vector3 n) {
    map.x.at(i, j) = static_cast<float>(n.x);
    map.y.at(i, j) = static_cast<float>(n.y);
    map.z.at(i, j) = static_cast<float>(n.z);
}

// What a strip has counted.
struct Counts {
    std::int64_t covered = 0, backward = 0, singular = 0;
};

Vector3 sum(Vector3 a, Vector3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }

// NaN if the length is 0.
Vector3 normalised(Vector3 a) {
    const double length = std::sqrt(a.x * a.x + a.y * a.y + a.z * a.z);
    return {a.x / length, a.y / length, a.z / length};
}

// Converts strips of rows, without the padding. The coverage is that of subsamples.
class StripConverter {
public:
    StripConverter(const NormalMap& map, const TangentSpace& space, const CoverageMap& coverage, Direction direction,
                   int subsamples, ConvertedMap& result)
        : map_(map), space_(space), coverage_(coverage), direction_(direction), subsamples_(subsamples),
          result_(result) {}

    // Threads may convert different strips at the same time.
    void run(int strip) {
        std::vector<Covered> covered;
        const Overlaps overlaps = coverage_.cover(strip, covered);
        overlaps_ += overlaps.same;
        moved_ += overlaps.moved;
        const Extent extent = map_.extent();
        const int first = strip * coverage_.strip_rows() / subsamples_;
        const int last = std::min(extent.height, first + coverage_.strip_rows() / subsamples_);
        Strip work{covered, static_cast<std::size_t>(extent.width) * static_cast<std::size_t>(subsamples_)};
        for (int j = first; j < last; ++j) {
            for (int i = 0; i < extent.width; ++i) convert(work, i, j, j - first);
        }
        covered_ += work.counts.covered;
        backward_ += work.counts.backward;
        singular_ += work.counts.singular;
    }
    void finish() {
        result_.covered = covered_;
        result_.overlaps = overlaps_;
        result_.moved = moved_;
        result_.backward = backward_;
        result_.singular = singular_;
    }

private:
    struct Strip {
        const std::vector<Covered>& covered;  // of subsamples
        std::size_t width;                    // in subsamples
        std::int32_t triangle = kNoTriangle;  // whose frames these are
        CornerFrames frames = {};
        Counts counts = {};
    };
    // Subsamples of one texel, those inside of triangles if there are any.
    struct Sum {
        Vector3 normal{};
        int count = 0, singular = 0;
        bool inside = false;
    };

    void convert(Strip& strip, int i, int j, int row) {
        const Vector3 stored{static_cast<double>(map_.x.at(i, j)), static_cast<double>(map_.y.at(i, j)),
                             static_cast<double>(map_.z.at(i, j))};
        const Vector3 from = direction_ == Direction::to_object ? read_texel(space_.decoder, stored) : stored;
        const auto n = static_cast<std::size_t>(subsamples_);
        Sum all;
        for (std::size_t k = 0; k < n * n; ++k) {
            const Covered& sample = strip.covered[(static_cast<std::size_t>(row) * n + k / n) * strip.width +
                                                  static_cast<std::size_t>(i) * n + k % n];
            if (sample.triangle != kNoTriangle && (sample.inside || !all.inside)) add(strip, sample, from, all);
        }
        finish(strip.counts, all, i, j);
    }

    void add(Strip& strip, const Covered& sample, Vector3 from, Sum& all) {
        if (sample.triangle != strip.triangle) {
            strip.triangle = sample.triangle;
            strip.frames = CornerFrames(space_, static_cast<std::size_t>(sample.triangle));
        }
        if (sample.inside && !all.inside) all = {{}, 0, 0, true};
        const Frame frame = strip.frames.at(sample.weights);
        const std::optional<Vector3> to =
            direction_ == Direction::to_object ? decode(frame, from) : encode(frame, from);
        if (!to) ++all.singular;
        if (to) all.normal = all.count++ == 0 ? *to : sum(all.normal, *to);
    }

    void finish(Counts& counts, const Sum& all, int i, int j) {
        Coverage& coverage = result_.coverage.at(i, j);
        if (all.count + all.singular == 0) {
            coverage = Coverage::none;
            result_.map.x.at(i, j) = kHole;
            return;
        }
        coverage = all.inside ? Coverage::triangle : Coverage::gutter;
        if (all.inside) ++counts.covered;
        const Vector3 n = all.count > 1 ? normalised(all.normal) : all.normal;
        if (all.count == 0 || std::isnan(n.z)) {
            ++counts.singular;
            return set(result_.map, i, j, {0.0, 0.0, 1.0});
        }
        if (direction_ == Direction::to_tangent && n.z < 0.0) ++counts.backward;
        set(result_.map, i, j, n);
    }

    const NormalMap& map_;
    const TangentSpace& space_;
    const CoverageMap& coverage_;
    const Direction direction_;
    const int subsamples_;
    ConvertedMap& result_;
    std::atomic<std::int64_t> covered_{0}, overlaps_{0}, moved_{0}, backward_{0}, singular_{0};
};

// Fills the texels up to `width` texels from those that have a normal. The others become background.
Result<void> pad(ConvertedMap& result, std::int64_t width, const Execution& execution, ProgressSpan span) {
    NormalMap& map = result.map;
    const auto fill = [&](const NearestTexel& hole) {
        if (hole.squared > width * width) return set(map, hole.i, hole.j, {0.0, 0.0, 1.0});
        for (Plane<float>* plane : {&map.x, &map.y, &map.z})
            plane->at(hole.i, hole.j) = plane->at(hole.column, hole.row);
        result.coverage.at(hole.i, hole.j) = Coverage::padding;
    };
    return visit_holes(map.x.view(), Wrap::repeat, Wrap::repeat, execution, span, fill);
}

Result<ConvertedMap> convert(const NormalMap& map, const TangentSpace& space, Direction direction,
                             const ConvertOptions& options, const Execution& execution) {
    const int padding = options.padding, subsamples = options.subsamples;
    return no_throw(execution, [&]() -> Result<ConvertedMap> {
        if (auto usable = check_usable(map); !usable) return usable.error();
        if (auto valid = validate(options); !valid) return valid.error();
        if (auto sound = check_part(space.part); !sound) return sound.error().of(space.file);
        if (const auto checked = check_space(space); !checked) return checked.error().of(space.file);
        const int gutter = direction == Direction::to_object ? std::min(kGutter, padding) : 0;
        const Extent extent{map.extent().width * subsamples, map.extent().height * subsamples};
        const auto coverage = CoverageMap::make(space.part, space.uv_set, extent, gutter * subsamples, subsamples);
        if (!coverage) return coverage.error().of(space.file);
        ConvertedMap result{NormalMap(map.extent()), Plane<Coverage>(map.extent())};
        StripConverter converter(map, space, *coverage, direction, subsamples, result);
        const auto strips = [&](int begin, int end) {
            for (int strip = begin; strip < end; ++strip) converter.run(strip);
        };
        const auto converted = parallel_for(execution, coverage->strips(), 1, strips, {0.0, 0.7});
        if (!converted) return converted.error();
        converter.finish();
        if (result.covered == 0)
            return Error{ErrorCode::bad_option, space.file, "its triangles cover no texel of the map"};
        const std::int64_t width = std::min(padding, 2 * kMaxExtent) - gutter;
        if (const auto padded = pad(result, width, execution, {0.7, 1.0}); !padded) return padded.error();
        for (const Extra extra : kExtras) result.map[extra] = map[extra].clone();
        return result;
    });
}

}  // namespace

Result<void> validate(const ConvertOptions& options) { return check_fields(options); }

Result<ConvertedMap> to_object_space(const NormalMap& map, const TangentSpace& space, const ConvertOptions& options,
                                     const Execution& execution) {
    return convert(map, space, Direction::to_object, options, execution);
}

Result<ConvertedMap> to_tangent_space(const NormalMap& map, const TangentSpace& space, const ConvertOptions& options,
                                      const Execution& execution) {
    return convert(map, space, Direction::to_tangent, options, execution);
}

Result<ConvertedMap> refit(const NormalMap& map, const TangentSpace& from, const TangentSpace& to,
                           const ConvertOptions& options, const Execution& execution) {
    const Execution first = part_of(execution, 0.0, 0.5), second = part_of(execution, 0.5, 1.0);
    const auto object = to_object_space(map, from, {kPadAll, options.subsamples}, first);
    if (!object) return object.error();
    auto result = to_tangent_space(object->map, to, options, second);
    if (!result) return result;
    const auto [width, height] = map.extent();
    for (int j = 0; j < height; ++j) {
        for (int i = 0; i < width; ++i) {
            if (result->coverage.at(i, j) == Coverage::triangle && object->coverage.at(i, j) != Coverage::triangle)
                ++result->unmatched;
        }
    }
    return result;
}

}  // namespace tex::inline v1
