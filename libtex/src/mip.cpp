// SPDX-License-Identifier: Apache-2.0
// Edges, memory and threads; kernels/mip.cpp computes.
//
// A level holds the averages, not normalised, until the next level has been made from it; then it is
// finished in place: normalised and faded. So a chain needs no memory beside itself, but for a few rows for
// each thread. In the slope domain x and y of an unfinished level hold the averages of x/z and y/z, z
// nothing.

#include <tex/mip.h>

#include <algorithm>
#include <cassert>
#include <utility>
#include <vector>

#include "kernels/mip.h"
#include "rows/axis_filter.h"
#include "rows/border.h"
#include "rows/mip_rows.h"
#include "threads/guard.h"
#include "threads/parallel.h"

namespace tex {
namespace {

void finish_rows(NormalMap& level, MipDomain domain, float fade, int begin, int end) {
    for (int j = begin; j < end; ++j) {
        finish_row({level.x.row(j), level.y.row(j), level.z.row(j)}, level.extent().width, domain, fade);
    }
}

// One level and the next.
struct Step {
    NormalMap& from;
    NormalMap& to;
    int level;  // of `from`
    const MipOptions& options;
    AxisFilter x;
    AxisFilter y;

    [[nodiscard]] int planes() const { return options.domain == MipDomain::vector ? 3 : 2; }
    // The base level is the caller's: it is not averages but vectors, and stays as it is.
    [[nodiscard]] bool from_base() const { return level == 0; }
};

Plane<float>& plane_of(NormalMap& map, int plane) { return plane == 0 ? map.x : plane == 1 ? map.y : map.z; }

// The rows of averages that `to` is made of, with the rows beyond the border. In the slope domain those of
// the base level are computed here, from its vectors, and held while they are needed.
class SourceRows {
public:
    explicit SourceRows(const Step& step) : step_(step), converts_(step.from_base() && step.planes() == 2) {
        if (!converts_) return;
        const Extent held{step.from.extent().width, step.y.taps};
        p_ = Plane<float>(held);
        q_ = Plane<float>(held);
        held_.assign(static_cast<std::size_t>(step.y.taps), -1);
    }

    // Makes rows [first, first + taps) ready, those beyond the border included.
    void prepare(int first) {
        if (!converts_) return;
        for (int j = first; j < first + step_.y.taps; ++j) {
            const int slot = wrap_around(j, step_.y.taps);
            const int source = inside(j);
            int& held = held_[static_cast<std::size_t>(slot)];
            if (held == source) continue;
            const NormalMap& from = step_.from;
            slopes_of_vectors(from.x.row(source), from.y.row(source), from.z.row(source), from.extent().width,
                              p_.row(slot), q_.row(slot));
            held = source;
        }
    }

    const float* row(int plane, int j) {
        if (!converts_) return plane_of(step_.from, plane).row(inside(j));
        return (plane == 0 ? p_ : q_).row(wrap_around(j, step_.y.taps));
    }

private:
    [[nodiscard]] int inside(int j) const { return border_index(step_.options.wrap_y, j, step_.from.extent().height); }

    const Step& step_;
    const bool converts_;
    Plane<float> p_, q_;
    std::vector<int> held_;  // the row of the level that each slot holds
};

// Rows [begin, end) of step.to by any filter.
void filter_strip(const Step& step, int begin, int end) {
    const int width = step.from.extent().width;
    const int taps = step.y.taps;
    SourceRows source(step);
    MipRows filtered(step.x, step.y, step.options.wrap_x, width);
    std::vector<const float*> rows(static_cast<std::size_t>(taps));
    for (int j = begin; j < end; ++j) {
        const int first = 2 * j + step.y.first;
        source.prepare(first);
        for (int plane = 0; plane < step.planes(); ++plane) {
            for (int k = 0; k < taps; ++k) rows[static_cast<std::size_t>(k)] = source.row(plane, first + k);
            filtered.make(rows.data(), j, plane_of(step.to, plane).row(j));
        }
    }
}

// The same for the box filter from even sizes: one pass, nothing in between. A row of `from` belongs to one
// row of `to` only, and is finished as soon as that one is made.
void halve_strip(const Step& step, int begin, int end) {
    const int count = step.to.extent().width;
    SourceRows source(step);
    for (int j = begin; j < end; ++j) {
        source.prepare(2 * j);
        for (int plane = 0; plane < step.planes(); ++plane) {
            halve_rows(source.row(plane, 2 * j), source.row(plane, 2 * j + 1), count, plane_of(step.to, plane).row(j));
        }
        if (!step.from_base()) {
            finish_rows(step.from, step.options.domain, fade_at(step.options.fade, step.level), 2 * j, 2 * j + 2);
        }
    }
}

// Rows of an extent that are worth a thread's while.
int strip_rows(Extent extent) {
    constexpr int kTexels = 1 << 15;
    return std::max(1, kTexels / extent.width);
}

// Steps that halve, one after the other, strip by strip of the last level: what a step makes is still in
// the cache when the next one reads it.
Result<void> halve_levels(const std::vector<Step>& steps, const Execution& execution, ProgressSpan span) {
    const int last = static_cast<int>(steps.size()) - 1;
    const Extent extent = steps.back().to.extent();
    const auto strip = [&](int begin, int end) {
        for (int k = 0; k <= last; ++k)
            halve_strip(steps[static_cast<std::size_t>(k)], begin << (last - k), end << (last - k));
    };
    const Extent strip_of_first{steps.front().to.extent().width << last, extent.height};
    return parallel_for(execution, extent.height, strip_rows(strip_of_first), strip, span);
}

Result<void> finish_level(NormalMap& level, const MipOptions& options, int index, const Execution& execution,
                          ProgressSpan span) {
    const auto strip = [&](int begin, int end) {
        finish_rows(level, options.domain, fade_at(options.fade, index), begin, end);
    };
    return parallel_for(execution, level.extent().height, strip_rows(level.extent()), strip, span);
}

// One step by any filter, and the end of the level that it came from.
Result<void> filter_level(const Step& step, const Execution& execution, ProgressSpan span) {
    const auto strip = [&](int begin, int end) { filter_strip(step, begin, end); };
    auto done = parallel_for(execution, step.to.extent().height, strip_rows(step.to.extent()), strip, span);
    if (!done || step.from_base()) return done;
    return finish_level(step.from, step.options, step.level, execution, {span.to, span.to});
}

Step make_step(MipChain& chain, int level, const MipOptions& options) {
    NormalMap& from = chain.levels[static_cast<std::size_t>(level)];
    NormalMap& to = chain.levels[static_cast<std::size_t>(level) + 1];
    const Extent extent = from.extent();
    return {from,
            to,
            level,
            options,
            make_axis_filter(options.filter, extent.width),
            make_axis_filter(options.filter, extent.height)};
}

// The steps from `level` on that halve, at most four: a strip of sixteen rows fits into the cache.
std::vector<Step> halving_steps(MipChain& chain, int level, const MipOptions& options) {
    const int end = std::min(level + 4, static_cast<int>(chain.levels.size()) - 1);
    std::vector<Step> steps;
    for (; level < end; ++level) {
        const Extent extent = chain.levels[static_cast<std::size_t>(level)].extent();
        if (options.filter != MipFilter::box || extent.width % 2 != 0 || extent.height % 2 != 0) break;
        steps.push_back(make_step(chain, level, options));
    }
    return steps;
}

}  // namespace

Result<MipChain> build_mip_chain(NormalMap base, const MipOptions& options, const Execution& execution) {
    assert(!base.x.empty() && options.levels >= 0);
    assert(!options.fade || (options.fade->first >= 0 && options.fade->first < options.fade->last));
    return guarded([&]() -> Result<MipChain> {
        const Extent extent = base.extent();
        const int complete = level_count(extent);
        const int count = options.levels > 0 ? std::min(options.levels, complete) : complete;
        MipChain chain;
        chain.levels.push_back(std::move(base));
        for (int k = 1; k < count; ++k) chain.levels.emplace_back(level_extent(extent, k));

        double done = 0.0;
        for (int k = 0; k + 1 < count;) {
            // Three quarters of what is left, as each level has a quarter of the texels of the one before.
            const double next = done + (1.0 - done) * 0.75;
            const std::vector<Step> halving = halving_steps(chain, k, options);
            const auto made = halving.empty() ? filter_level(make_step(chain, k, options), execution, {done, next})
                                              : halve_levels(halving, execution, {done, next});
            if (!made) return made.error();
            k += halving.empty() ? 1 : static_cast<int>(halving.size());
            done = next;
        }
        if (count > 1) {
            const auto last = finish_level(chain.levels.back(), options, count - 1, execution, {done, 1.0});
            if (!last) return last.error();
        }
        return chain;
    });
}

}  // namespace tex
