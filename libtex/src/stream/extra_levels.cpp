// SPDX-License-Identifier: Apache-2.0

#include "stream/extra_levels.h"

#include <utility>

#include <tex/types.h>

#include "rows/extra_rows.h"
#include "rows/mip_rows.h"

namespace tex::inline v1 {
namespace {

// Filters rows [begin, end) of a plane of the next level.
void filter_strip(const LevelFilter& filter, PlaneView<const float> from, Plane<float>& to, int begin, int end) {
    MipRows rows(filter);
    std::vector<const float*> window(static_cast<std::size_t>(filter.y.taps));
    for (int j = begin; j < end; ++j) {
        for (int k = 0; k < filter.y.taps; ++k) window[static_cast<std::size_t>(k)] = from.row(filter.source(j, k));
        rows.make(window.data(), j, to.row(j));
    }
}

Result<void> add_extra(MipChain& chain, Extra extra, const MipOptions& options, const Execution& execution) {
    const ExtraKind kind = kind_of(extra, options);
    const NormalMap& base = chain.levels.front();
    const Plane<float>& values = base[extra];
    if (values.empty() || chain.levels.size() < 2) return {};
    const Extent extent = base.extent();
    Plane<float> averages(extent);
    const auto begin_with = [&](int begin, int end) {
        for (int j = begin; j < end; ++j) values_to_average(kind, values.row(j), extent.width, averages.row(j));
    };
    const Execution silent = execution.quiet();
    if (Result<void> done = parallel_for(silent, extent.height, rows_per_piece(extent), begin_with); !done) return done;
    auto levels = smaller_levels(base, std::move(averages), kind, options.roughness, options,
                                 static_cast<int>(chain.levels.size()), silent, {});
    if (!levels) return levels.error();
    for (std::size_t k = 0; k < levels->size(); ++k) chain.levels[k + 1][extra] = std::move((*levels)[k]);
    return {};
}

}  // namespace

Result<std::vector<Plane<float>>> smaller_levels(const NormalMap& normals, Plane<float> averages, ExtraKind kind,
                                                 RoughnessModel model, const MipOptions& options, int count,
                                                 const Execution& execution, ProgressSpan span) {
    std::vector<Plane<float>> levels, held;  // `held`: the averages of the larger level
    std::vector<PlaneView<const float>> from;
    if (follows_normals(kind)) from = {normals.x.view(), normals.y.view(), normals.z.view()};
    from.push_back(std::as_const(averages).view());
    double done = span.from;
    for (int level = 1; level < count; ++level) {
        const Extent extent = level_extent(normals.extent(), level);
        std::vector<Plane<float>> to;
        for (std::size_t k = 0; k < from.size(); ++k) to.emplace_back(extent);
        Plane<float>& values = levels.emplace_back(extent);
        const LevelFilter filter(from[0].extent, options);
        const auto strip = [&](int begin, int end) {
            for (std::size_t plane = 0; plane < to.size(); ++plane)
                filter_strip(filter, from[plane], to[plane], begin, end);
            const bool follows = to.size() > 1;
            for (int j = begin; j < end; ++j) {
                const VectorRow mean = follows ? VectorRow{to[0].row(j), to[1].row(j), to[2].row(j)} : VectorRow{};
                values_of_averages(kind, model, mean, to.back().row(j), extent.width, values.row(j));
            }
        };
        const double next = level + 1 < count ? done + (span.to - done) * 0.75 : span.to;
        const auto made = parallel_for(execution, extent.height, rows_per_piece(extent), strip, {done, next});
        if (!made) return made.error();
        held = std::move(to);
        from.clear();
        for (const Plane<float>& plane : held) from.push_back(plane.view());
        done = next;
    }
    return levels;
}

Result<void> add_extras(MipChain& chain, const MipOptions& options, const Execution& execution) {
    for (const Extra extra : kExtras) {
        if (auto done = add_extra(chain, extra, options, execution); !done) return done;
    }
    return {};
}

}  // namespace tex::inline v1
