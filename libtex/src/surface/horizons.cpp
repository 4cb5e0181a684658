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

// A plane in the memory of one that is not needed any more, if that is large enough: taking it from the system costs a
// tenth of the time of 16 directions.
Plane<float> reused(Plane<float> old, Extent extent) {
    const auto elements = [](Extent of, std::ptrdiff_t stride) { return stride * of.height; };
    const std::ptrdiff_t stride = padded_stride<float>(extent.width);
    if (old.empty() || elements(old.extent(), old.stride()) < elements(extent, stride)) return Plane<float>(extent);
    const auto kept = std::allocate_shared<Plane<float>>(WorkingAllocator<Plane<float>>(), std::move(old));
    Plane<float> plane(extent, stride, std::shared_ptr<float>(kept, kept->row(0)));
    plane.clear_padding();
    return plane;
}

// Turns a plane over its diagonal, into the memory of `spare`, which gets that of the old one.
Result<void> turn_plane(Plane<float>& plane, Plane<float>& spare, const Execution& execution) {
    if (plane.empty()) return {};
    Plane<float> to = reused(std::move(spare), turned(plane.extent()));
    const auto body = [&](int begin, int end) {
        for (int top = begin; top < end; top += kTile) {
            for (int left = 0; left < plane.extent().width; left += kTile) {
                const int bottom = std::min(top + kTile, end), right = std::min(left + kTile, plane.extent().width);
                for (int i = left; i < right; ++i) {
                    for (int j = top; j < bottom; ++j) to.row(i)[j] = plane.row(j)[i];
                }
            }
        }
    };
    const Execution silent = execution.quiet();
    if (auto done = parallel_for(silent, plane.extent().height, 4 * kTile, body); !done) return done;
    spare = std::move(plane);
    plane = std::move(to);
    return {};
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
    // In the memory of another field.
    [[nodiscard]] HorizonField room_for(Extent extent, HorizonField used = {}) const {
        HorizonField field;
        field.heights = reused(std::move(used.heights), extent);
        if (!has_slopes_) return field;
        field.p = reused(std::move(used.p), extent);
        field.q = reused(std::move(used.q), extent);
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
        for (auto& of_orientation : lines_)
            of_orientation.reserve(static_cast<std::size_t>(options.directions + options.horizons));
        // The light is that of the middles of equal parts of a turn; horizons lie at their ends.
        if (options.occlusion || options.sky_view || options.bent) {
            const bool have_opposites = options.directions % 2 == 0;
            const int count = have_opposites ? options.directions / 2 : options.directions;
            for (int k = 0; k < count; ++k) add_lines((k + 0.5) / options.directions, have_opposites, kLight);
        }
        for (int k = 0; k < options.horizons; ++k) add_lines(static_cast<double>(k) / options.horizons, false, k);
        if (execution.threads == 1)
            alone_.emplace(extent_);
        else
            pool_.emplace();
    }

    Result<SkyMaps> make() {
        SkyMaps maps;
        if (options_.horizons > 0) maps.horizons = Plane<float>({extent_.width, extent_.height * options_.horizons});
        SkySums sums = room_for(turned(extent_));
        HorizonField used;
        if (auto done = sweep_all(true, sums, maps.horizons, used); !done) return done.error();
        for (Plane<float>* const plane : {&sums.occlusion, &sums.sky, &sums.x, &sums.y, &sums.z}) {
            if (auto done = turn_plane(*plane, used.heights, execution_); !done) return done.error();
        }
        if (auto done = sweep_all(false, sums, maps.horizons, used); !done) return done.error();
        maps.occlusion = std::move(sums.occlusion);
        maps.sky_view = std::move(sums.sky);
        maps.bent.x = std::move(sums.x);
        maps.bent.y = std::move(sums.y);
        maps.bent.z = std::move(sums.z);
        return maps;
    }

private:
    static constexpr int kLight = -1;
    struct Lines {
        SweepLines sweep;
        int horizon;  // which one; kLight: none
    };

    // A texel is 1 wide and `tall` high.
    void add_lines(double turn, bool has_opposite, int horizon) {
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
        const bool upwards = major > 0.0, is_level = options_.distance == 0.0f;
        const auto sky_of = [&](double sign) -> SkyDirection {
            return {static_cast<float>(sign * x), static_cast<float>(sign * y), static_cast<float>(rows), is_level};
        };
        SweepLines lines;
        lines.directions[0] = {sky_of(1.0), upwards};
        lines.directions[1] = {sky_of(-1.0), !upwards};
        lines.count = has_opposite ? 2 : 1;
        lines.slant = minor / major;
        if (!is_level) lines.bend = static_cast<float>(1.0 / (rows * rows * static_cast<double>(options_.distance)));
        lines_[is_turned ? 1 : 0].push_back({lines, horizon});
    }

    [[nodiscard]] SkySums room_for(Extent extent) const {
        SkySums sums;
        if (options_.occlusion) sums.occlusion = Plane<float>(extent, 0.0f);
        if (options_.sky_view) sums.sky = Plane<float>(extent, 0.0f);
        if (!options_.bent) return sums;
        for (Plane<float>* const plane : {&sums.x, &sums.y, &sums.z}) *plane = Plane<float>(extent, 0.0f);
        return sums;
    }

    Result<HorizonField> field(bool is_turned, HorizonField used) const {
        HorizonField field = rows_.room_for(is_turned ? turned(extent_) : extent_, std::move(used));
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

    // The directions of one orientation; after those that are not turned, the sums are finished. `used` is a field that
    // is not needed any more, and then that of this orientation.
    Result<void> sweep_all(bool is_turned, SkySums& sums, Plane<float>& horizons, HorizonField& used) {
        Result<HorizonField> made = field(is_turned, std::move(used));
        if (!made) return made.error();
        for (const Lines& lines : lines_[is_turned ? 1 : 0]) {
            if (lines.horizon == kLight) {
                if (auto done = sweep(*made, lines.sweep, sums); !done) return done;
                continue;
            }
            SkySums one;
            one.horizon = is_turned ? Plane<float>(made->extent()) : slice(horizons, lines.horizon);
            if (auto done = sweep(*made, lines.sweep, one); !done) return done;
            if (!is_turned) continue;
            Plane<float> straight = slice(horizons, lines.horizon);
            turn(one.horizon, one.horizon.extent().height, 0, straight);
        }
        if (is_turned) {
            used = std::move(*made);
            return {};
        }
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

    Result<void> sweep(const HorizonField& field, const SweepLines& lines, SkySums& sums) {
        const HorizonSweep sweep(field, lines, sums);
        const auto body = [&](int begin, int end) {
            if (alone_) {
                for (int band = begin; band < end; ++band) sweep.sweep(band, *alone_);
                return;
            }
            const auto stacks = pool_->take([&] { return std::make_unique<HorizonSweep::Stacks>(extent_); });
            for (int band = begin; band < end; ++band) sweep.sweep(band, *stacks);
        };
        const auto all = static_cast<double>(lines_[0].size() + lines_[1].size());
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
    WorkingVector<Lines> lines_[2];              // not turned, turned
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
