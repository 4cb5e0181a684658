// SPDX-License-Identifier: Apache-2.0

#include "rows/mip_rows.h"

#include <algorithm>
#include <limits>

#include <tex/mip_chain.h>

#include "kernels/mip.h"
#include "rows/border.h"

namespace tex {

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

MipRows::MipRows(const LevelFilter& filter) : filter_(filter) {
    if (filter.halves) return;
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

}  // namespace tex
