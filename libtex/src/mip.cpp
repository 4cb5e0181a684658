// SPDX-License-Identifier: Apache-2.0
// Handles edges, memory and threads; kernels/mip.cpp computes.
//
// A level holds averages, not normalised, until the next level has been made from it. Then it is finished in place:
// normalised and faded. So a chain needs no memory besides its own, except a few rows for each thread. In the slope
// domain, x and y of an unfinished level hold the averages of x/z and y/z, and z is unused.

#include <tex/mip.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "fields/field_check.h"
#include "fields/mip_fields.h"
#include "kernels/mip.h"
#include "rows/axis_filter.h"
#include "rows/border.h"
#include "rows/mip_rows.h"
#include "rows/usable.h"
#include "stream/extra_levels.h"
#include "threads/no_throw.h"
#include "threads/parallel.h"

namespace tex::inline v1 {
namespace {

void finish_rows(NormalMap& level, const MipOptions& options, int index, int begin, int end) {
    for (int j = begin; j < end; ++j)
        finish_row({level.x.row(j), level.y.row(j), level.z.row(j)}, level.extent().width, options, index);
}

// One level and the next.
struct Halving {
    NormalMap& from;
    NormalMap& to;
    int level;  // the level of `from`
    const MipOptions& options;
    LevelFilter filter;

    [[nodiscard]] int planes() const { return averaged_planes(options); }
    // The base level belongs to the caller: it holds vectors, not averages, and does not change.
    [[nodiscard]] bool from_base() const { return level == 0; }
};

// Makes rows [begin, end) of step.to. If the filter halves, a row of `from` contributes to only one row of `to`, and is
// finished as soon as that row is made.
void make_strip(const Halving& step, int begin, int end) {
    LevelSource source(step.filter, step.from, step.options, step.from_base());
    MipRows rows(step.filter);
    for (int j = begin; j < end; ++j) {
        source.prepare(j);
        for (int plane = 0; plane < step.planes(); ++plane)
            rows.make(source.window(plane, j), j, plane_of(step.to, plane).row(j));
        if (step.filter.halves && !step.from_base()) {
            finish_rows(step.from, step.options, step.level, 2 * j, 2 * j + 2);
        }
    }
}

Result<void> finish_level(NormalMap& level, const MipOptions& options, int index, const Execution& execution,
                          ProgressSpan span) {
    const auto strip = [&](int begin, int end) { finish_rows(level, options, index, begin, end); };
    return parallel_for(execution, level.extent().height, rows_per_piece(level.extent()), strip, span);
}

Halving make_halving(MipChain& chain, int level, const MipOptions& options) {
    NormalMap& from = chain.levels[static_cast<std::size_t>(level)];
    NormalMap& to = chain.levels[static_cast<std::size_t>(level) + 1];
    return {from, to, level, options, LevelFilter(from.extent(), options)};
}

// The step from `level`. If it halves, the steps after it that also halve are included, at most four steps in all: a
// strip of sixteen rows fits into the cache.
std::vector<Halving> next_steps(MipChain& chain, int level, const MipOptions& options) {
    const int end = std::min(level + 4, static_cast<int>(chain.levels.size()) - 1);
    std::vector<Halving> steps;
    for (; level < end; ++level) {
        Halving step = make_halving(chain, level, options);
        const bool halves = step.filter.halves;
        if (steps.empty() || halves) steps.push_back(std::move(step));
        if (!halves) break;
    }
    return steps;
}

// Performs the steps one after the other, strip by strip of the last level: the output of a step is still in the cache
// when the next step reads it. Finishes the levels from which the steps started.
Result<void> make_levels(const std::vector<Halving>& steps, const Execution& execution, ProgressSpan span) {
    const int last = static_cast<int>(steps.size()) - 1;
    const Extent extent = steps.back().to.extent();
    const auto strip = [&](int begin, int end) {
        for (int k = 0; k <= last; ++k)
            make_strip(steps[static_cast<std::size_t>(k)], begin << (last - k), end << (last - k));
    };
    const Extent strip_of_first{steps.front().to.extent().width << last, extent.height};
    auto done = parallel_for(execution, extent.height, rows_per_piece(strip_of_first), strip, span);
    const Halving& first = steps.front();
    if (!done || first.filter.halves || first.from_base()) return done;
    return finish_level(first.from, first.options, first.level, execution, {span.to, span.to});
}

}  // namespace

Result<void> validate(const MipOptions& options) {
    if (options.fade && (options.fade->first < 0 || options.fade->first >= options.fade->last))
        return bad_option("fade: first must be 0 or more, and less than last");
    if (options.any_z && (options.domain != MipDomain::vector || options.fade))
        return bad_option("any_z: needs the domain vector and no fade");
    if (options.follow_normals() && options.domain != MipDomain::vector)
        return bad_option("blue and alpha: roughness and gloss need the domain vector");
    return check_fields(options);
}

Result<MipChain> build_mip_chain(NormalMap base, const MipOptions& options, const Execution& execution) {
    return no_throw(execution, [&]() -> Result<MipChain> {
        if (auto usable = check_usable(base); !usable) return usable.error();
        if (auto valid = validate(options); !valid) return valid.error();
        const Extent extent = base.extent();
        const int first = first_level(options, extent);
        const int count = first + levels_to_build(options, extent);
        const MipOptions all = counted_from_base(options, first);
        MipChain chain;
        chain.levels.push_back(std::move(base));
        for (int k = 1; k < count; ++k) chain.levels.emplace_back(level_extent(extent, k));

        double done = 0.0;
        for (int k = 0; k + 1 < count;) {
            // Three quarters of the remaining progress, because each level has a quarter of the texels of the one
            // before.
            const double next = done + (1.0 - done) * 0.75;
            const std::vector<Halving> steps = next_steps(chain, k, all);
            if (const auto made = make_levels(steps, execution, {done, next}); !made) return made.error();
            k += static_cast<int>(steps.size());
            done = next;
        }
        if (count > 1) {
            const auto last = finish_level(chain.levels.back(), all, count - 1, execution, {done, 1.0});
            if (!last) return last.error();
        }
        if (const auto added = add_extras(chain, all, execution); !added) return added.error();
        chain.levels.erase(chain.levels.begin(), chain.levels.begin() + first);
        return chain;
    });
}

}  // namespace tex::inline v1
