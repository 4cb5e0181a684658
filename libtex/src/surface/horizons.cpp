// SPDX-License-Identifier: Apache-2.0

#include "surface/horizons.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "kernels/slopes.h"
#include "memory/lent_memory.h"
#include "rows/math.h"
#include "surface/horizon_sweep.h"
#include "threads/pool.h"

namespace tex::inline v1 {
namespace {

constexpr int kTile = 16;  // texels of a side that are turned together: a line of a cache

Extent turned(Extent extent) { return {extent.height, extent.width}; }

// Rows of `from` become columns [first, first + from.height) of `to`.
void turn(const Plane<float>& from, int rows, int first, Plane<float>& to) {
    const int width = from.extent().width;
    for (int top = 0; top < rows; top += kTile) {
        const int bottom = std::min(top + kTile, rows);
        for (int left = 0; left < width; left += kTile) {
            for (int i = left; i < std::min(left + kTile, width); ++i) {
                float* const row = to.row(i) + first;
                for (int j = top; j < bottom; ++j) row[j] = from.row(j)[i];
            }
        }
    }
}

// A plane turned over its diagonal; the old one is given up.
Result<Plane<float>> turned_plane(Plane<float> from, const Execution& execution) {
    if (from.empty()) return Plane<float>();
    Plane<float> to(turned(from.extent()));
    const auto body = [&](int begin, int end) {
        for (int top = begin; top < end; top += kTile) {
            for (int left = 0; left < from.extent().width; left += kTile) {
                const int bottom = std::min(top + kTile, end), right = std::min(left + kTile, from.extent().width);
                for (int i = left; i < right; ++i) {
                    for (int j = top; j < bottom; ++j) to.row(i)[j] = from.row(j)[i];
                }
            }
        }
    };
    const Execution silent = execution.quiet();
    if (auto done = parallel_for(silent, from.extent().height, 4 * kTile, body); !done) return done.error();
    return to;
}

// The heights and slopes of some rows, in the order of the source.
class FieldRows {
public:
    FieldRows(const HorizonSource& source, bool has_slopes)
        : source_(source), has_slopes_(has_slopes), extent_(source.heights.extent()) {}

    // Rows [begin, end) into rows of `field`, of which `first` is the first one.
    void make(int begin, int end, int first, HorizonField& field) const {
        for (int j = begin; j < end; ++j)
            scale_heights(source_.heights.row(j), source_.strength.x, extent_.width, field.heights.row(j - first));
        if (!has_slopes_) return;
        const auto heights = [this](int j) { return source_.solid.row(j); };
        BakeRows bake(extent_, heights, source_.gradient, source_.head, begin);
        NormalMap row({extent_.width, 1});
        const NormalRow normals{row.x.row(0), row.y.row(0), row.z.row(0)};
        for (int j = begin; j < end; ++j) {
            bake.bake(j, normals);
            slopes_of_normals(normals, std::numeric_limits<float>::min(), extent_.width, field.p.row(j - first),
                              field.q.row(j - first));
        }
    }
    [[nodiscard]] HorizonField room_for(Extent extent) const {
        HorizonField field;
        field.heights = Plane<float>(extent);
        if (!has_slopes_) return field;
        field.p = Plane<float>(extent);
        field.q = Plane<float>(extent);
        return field;
    }

private:
    const HorizonSource& source_;
    const bool has_slopes_;
    const Extent extent_;
};

class Sky {
public:
    Sky(const HorizonSource& source, const OcclusionOptions& options, const Execution& execution, ProgressSpan span)
        : source_(source), options_(options), execution_(execution), span_(span), extent_(source.heights.extent()),
          rows_(source, options.occlusion || options.bent) {
        for (auto& of_orientation : directions_)
            of_orientation.reserve(static_cast<std::size_t>(options.directions + options.horizons));
        // The light is that of the middles of equal parts of a turn; horizons lie at their ends.
        if (options.occlusion || options.sky_view || options.bent) {
            for (int k = 0; k < options.directions; ++k) add_direction((k + 0.5) / options.directions, kLight);
        }
        for (int k = 0; k < options.horizons; ++k) add_direction(static_cast<double>(k) / options.horizons, k);
        if (execution.threads == 1)
            alone_.emplace(extent_);
        else
            pool_.emplace();
    }

    Result<SkyMaps> make() {
        SkyMaps maps;
        if (options_.horizons > 0) maps.horizons = Plane<float>({extent_.width, extent_.height * options_.horizons});
        SkySums sums = room_for(turned(extent_));
        if (auto done = sweep_all(true, sums, maps.horizons); !done) return done.error();
        for (Plane<float>* const plane : {&sums.occlusion, &sums.sky, &sums.x, &sums.y, &sums.z}) {
            auto straight = turned_plane(std::move(*plane), execution_);
            if (!straight) return straight.error();
            *plane = std::move(*straight);
        }
        if (auto done = sweep_all(false, sums, maps.horizons); !done) return done.error();
        maps.occlusion = std::move(sums.occlusion);
        maps.sky_view = std::move(sums.sky);
        maps.bent.x = std::move(sums.x);
        maps.bent.y = std::move(sums.y);
        maps.bent.z = std::move(sums.z);
        return maps;
    }

private:
    static constexpr int kLight = -1;
    struct Direction {
        SweepDirection sweep;
        int horizon;  // which one; kLight: none
    };

    // A texel is 1 wide and `tall` high.
    void add_direction(double turn, int horizon) {
        const double angle = 2.0 * math::kPi * turn;
        const double x = math::cos(angle), y = math::sin(angle);
        const double ratio = source_.strength.y == 0.0f
                                 ? 1.0
                                 : static_cast<double>(source_.strength.x) / static_cast<double>(source_.strength.y);
        const double tall = std::clamp(ratio, 1e-6, 1e6);
        const double across = x, down = -y / tall;  // texels in a unit of distance
        const bool is_turned = std::abs(across) > std::abs(down);
        const double major = is_turned ? across : down, minor = is_turned ? down : across;
        const double rows = std::abs(major);
        SweepDirection direction;
        direction.sky = {static_cast<float>(x), static_cast<float>(y), static_cast<float>(rows),
                         options_.distance == 0.0f};
        direction.shift = -minor / rows;
        direction.upwards = major > 0.0;
        if (options_.distance > 0.0f)
            direction.bend = static_cast<float>(1.0 / (rows * rows * static_cast<double>(options_.distance)));
        directions_[is_turned ? 1 : 0].push_back({direction, horizon});
    }

    [[nodiscard]] SkySums room_for(Extent extent) const {
        SkySums sums;
        if (options_.occlusion) sums.occlusion = Plane<float>(extent, 0.0f);
        if (options_.sky_view) sums.sky = Plane<float>(extent, 0.0f);
        if (!options_.bent) return sums;
        for (Plane<float>* const plane : {&sums.x, &sums.y, &sums.z}) *plane = Plane<float>(extent, 0.0f);
        return sums;
    }

    Result<HorizonField> field(bool is_turned) const {
        HorizonField field = rows_.room_for(is_turned ? turned(extent_) : extent_);
        field.across = is_turned ? source_.head.wrap_y : source_.head.wrap_x;
        field.down = is_turned ? source_.head.wrap_x : source_.head.wrap_y;
        const int strip = std::max(4 * kTile, 4 * source_.gradient.radius);
        const auto body = [&](int begin, int end) {
            if (!is_turned) {
                rows_.make(begin, end, 0, field);
                return;
            }
            HorizonField few = rows_.room_for({extent_.width, end - begin});
            rows_.make(begin, end, begin, few);
            turn(few.heights, end - begin, begin, field.heights);
            if (few.p.empty()) return;
            turn(few.p, end - begin, begin, field.p);
            turn(few.q, end - begin, begin, field.q);
        };
        const Execution silent = execution_.quiet();
        if (auto done = parallel_for(silent, extent_.height, strip, body); !done) return done.error();
        return field;
    }

    // The directions of one orientation; after those that are not turned, the sums are finished.
    Result<void> sweep_all(bool is_turned, SkySums& sums, Plane<float>& horizons) {
        const Result<HorizonField> made = field(is_turned);
        if (!made) return made.error();
        for (const Direction& direction : directions_[is_turned ? 1 : 0]) {
            if (direction.horizon == kLight) {
                if (auto done = sweep(*made, direction.sweep, sums); !done) return done;
                continue;
            }
            SkySums one;
            one.horizon = is_turned ? Plane<float>(made->extent()) : slice(horizons, direction.horizon);
            if (auto done = sweep(*made, direction.sweep, one); !done) return done;
            if (!is_turned) continue;
            Plane<float> straight = slice(horizons, direction.horizon);
            turn(one.horizon, one.horizon.extent().height, 0, straight);
        }
        if (is_turned) return {};
        const auto finish = [&](int begin, int end) {
            for (int j = begin; j < end; ++j) {
                const auto slopes = [&](const Plane<float>& plane) { return plane.empty() ? nullptr : plane.row(j); };
                finish_sky(made->heights.row(j), slopes(made->p), slopes(made->q), options_.directions, extent_.width,
                           sums.at(j, 0));
                SkyRow horizon{};
                for (int k = 0; k < options_.horizons; ++k) {
                    horizon.horizon = horizons.row(k * extent_.height + j);
                    finish_sky(made->heights.row(j), nullptr, nullptr, 1, extent_.width, horizon);
                }
            }
        };
        const Execution silent = execution_.quiet();
        return parallel_for(silent, extent_.height, rows_per_piece(extent_), finish);
    }

    Result<void> sweep(const HorizonField& field, const SweepDirection& direction, SkySums& sums) {
        const HorizonSweep sweep(field, direction, sums);
        const auto body = [&](int begin, int end) {
            if (alone_) {
                for (int band = begin; band < end; ++band) sweep.sweep(band, *alone_);
                return;
            }
            const auto stacks = pool_->take([&] { return std::make_unique<HorizonSweep::Stacks>(extent_); });
            for (int band = begin; band < end; ++band) sweep.sweep(band, *stacks);
        };
        const auto all = static_cast<double>(directions_[0].size() + directions_[1].size());
        const auto at = [&](int done) { return span_.from + (span_.to - span_.from) * done / all; };
        const ProgressSpan part{at(done_), at(done_ + 1)};
        ++done_;
        return parallel_for(execution_, sweep.bands(), 1, body, part);
    }

    // The rows of horizon k.
    [[nodiscard]] Plane<float> slice(Plane<float>& horizons, int k) const {
        return {extent_, horizons.stride(),
                std::shared_ptr<float>(std::shared_ptr<float>(), horizons.row(k * extent_.height))};
    }

    const HorizonSource& source_;
    const OcclusionOptions& options_;
    const Execution& execution_;
    const ProgressSpan span_;
    const Extent extent_;
    const FieldRows rows_;
    WorkingVector<Direction> directions_[2];     // not turned, turned
    std::optional<HorizonSweep::Stacks> alone_;  // of the only thread, which makes no others
    std::optional<Pool<HorizonSweep::Stacks>> pool_;
    int done_ = 0;
};

}  // namespace

Result<SkyMaps> sky_of(const HorizonSource& source, const OcclusionOptions& options, const Execution& execution,
                       ProgressSpan span) {
    return Sky(source, options, execution, span).make();
}

}  // namespace tex::inline v1
