// SPDX-License-Identifier: Apache-2.0

#include "rows/mip_rows.h"

#include <algorithm>
#include <limits>

#include <tex/types.h>

#include "kernels/mip.h"
#include "rows/border.h"
#include "rows/whole_vectors.h"

namespace tex::inline v1 {

int first_level(const MipOptions& options, Extent base) {
    int level = 0;
    for (; options.max_side > 0; ++level) {
        const Extent extent = level_extent(base, level);
        if (std::max(extent.width, extent.height) <= options.max_side) break;
    }
    return level;
}

int levels_to_build(const MipOptions& options, Extent base) {
    const int complete = level_count(level_extent(base, first_level(options, base)));
    return options.levels > 0 ? std::min(options.levels, complete) : complete;
}

MipOptions counted_from_base(MipOptions options, int first) {
    if (options.fade) options.fade = Fade{options.fade->first + first, options.fade->last + first};
    return options;
}

float fade_at(const std::optional<Fade>& fade, int level) {
    if (!fade) return 0.0f;
    const float t = static_cast<float>(level - fade->first) / static_cast<float>(fade->last - fade->first);
    return std::clamp(t, 0.0f, 1.0f);
}

void finish_row(NormalRow row, int width, const MipOptions& options, int level) {
    const float fade = fade_at(options.fade, level);
    if (options.domain == MipDomain::slope) return finish_slopes(row.x, row.y, row.z, width, fade);
    finish_vectors(row.x, row.y, row.z, width, fade, options.any_z ? -std::numeric_limits<float>::infinity() : 0.0f);
}

LevelFilter::LevelFilter(Extent from_extent, const MipOptions& options)
    : from(from_extent), to(level_extent(from_extent, 1)), wrap_x(options.wrap_x), wrap_y(options.wrap_y),
      x(make_axis_filter(options.filter, from.width)), y(make_axis_filter(options.filter, from.height)),
      halves(options.filter == MipFilter::box && from.width % 2 == 0 && from.height % 2 == 0) {}

int LevelFilter::source(int j, int k) const { return border_index(wrap_y, 2 * j + y.first + k, from.height); }

LevelSource::LevelSource(const LevelFilter& filter, const NormalMap& from, const MipOptions& options, bool from_base)
    : filter_(filter), from_(from), taps_(filter.y.taps), converts_(from_base && averaged_planes(options) == 2),
      window_(static_cast<std::size_t>(taps_)) {
    if (!converts_) return;
    const Extent held{from.extent().width, taps_};
    p_ = Plane<float>(held);
    q_ = Plane<float>(held);
    held_.assign(static_cast<std::size_t>(taps_), -1);
}

int LevelSource::slot_of(int j, int k) const { return wrap_around(2 * j + filter_.y.first + k, taps_); }

void LevelSource::prepare(int j) {
    for (int k = 0; converts_ && k < taps_; ++k) {
        const int slot = slot_of(j, k);
        const int source = filter_.source(j, k);
        int& held = held_[static_cast<std::size_t>(slot)];
        if (held == source) continue;
        const float* const from[] = {from_.x.row(source), from_.y.row(source), from_.z.row(source)};
        float* const to[] = {p_.row(slot), q_.row(slot)};
        in_whole_vectors(from_.extent().width, from, to, [](const float* const* n, float* const* pq, int count) {
            slopes_of_vectors(n[0], n[1], n[2], count, pq[0], pq[1]);
        });
        held = source;
    }
}

const float* const* LevelSource::window(int plane, int j) {
    for (int k = 0; k < taps_; ++k) {
        window_[static_cast<std::size_t>(k)] =
            converts_ ? (plane == 0 ? p_ : q_).row(slot_of(j, k)) : plane_of(from_, plane).row(filter_.source(j, k));
    }
    return window_.data();
}

MipRows::MipRows(const LevelFilter& filter) : filter_(filter) {
    if (filter.halves) return;
    row_ = Plane<float>(Extent{filter.to.width, 1});
    across_.emplace(filter.x, filter.wrap_x, filter.from.width);
    weights_.resize(static_cast<std::size_t>(filter.y.taps));
}

void MipRows::make(const float* const* rows, int j, float* out) {
    if (!across_) return halve_rows(rows[0], rows[1], filter_.to.width, out);
    const AxisFilter& y = filter_.y;
    for (int k = 0; k < y.taps; ++k) weights_[static_cast<std::size_t>(k)] = y.weight(k, j);
    filter_rows(rows, weights_.data(), y.taps, filter_.from.width, across_->row());
    across_->run(out);
}

void MipRows::make_exactly(const float* const* rows, int j, float* out) {
    if (!across_) {
        // 16 texels of the result are made of whole vectors.
        const int whole = filter_.to.width / kWhole * kWhole, rest = filter_.to.width - whole;
        if (whole > 0) halve_rows(rows[0], rows[1], whole, out);
        if (rest == 0) return;
        float ends[2][2 * kWhole] = {}, made[kWhole];
        for (int k = 0; k < 2; ++k) std::copy_n(rows[k] + 2 * whole, 2 * rest, ends[k]);
        halve_rows(ends[0], ends[1], rest, made);
        std::copy_n(made, rest, out + whole);
        return;
    }
    const AxisFilter& y = filter_.y;
    for (int k = 0; k < y.taps; ++k) weights_[static_cast<std::size_t>(k)] = y.weight(k, j);
    const int whole = filter_.from.width / kWhole * kWhole, rest = filter_.from.width - whole;
    if (whole > 0) filter_rows(rows, weights_.data(), y.taps, whole, across_->row());
    if (rest > 0) {
        float ends[kMostTaps][kWhole] = {};
        const float* end_rows[kMostTaps];
        for (int k = 0; k < y.taps; ++k) {
            std::copy_n(rows[k] + whole, rest, ends[k]);
            end_rows[k] = ends[k];
        }
        filter_rows(end_rows, weights_.data(), y.taps, rest, across_->row() + whole);
    }
    across_->run(row_.row(0));
    std::copy_n(row_.row(0), filter_.to.width, out);
}

}  // namespace tex::inline v1
