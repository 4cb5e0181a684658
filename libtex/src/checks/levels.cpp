// SPDX-License-Identifier: Apache-2.0

#include "checks/levels.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include <tex/types.h>

#include "kernels/level_sums.h"
#include "kernels/mip.h"
#include "kernels/stored.h"
#include "threads/parallel.h"

namespace tex::inline v1 {
namespace {

// A larger level, or the rows of it that begin at row `first`.
struct LargerRows {
    const Plane<float>& rows;
    Extent extent;  // of the whole level
    int first = 0;
    [[nodiscard]] const float* row(int j) const { return rows.row(j - first); }
};

// Texels first_covered() to last_covered() - 1 of `from` lie at least partly under texel k of `to`.
int first_covered(int k, int from, int to) { return static_cast<int>(std::int64_t{k} * from / to); }
int last_covered(int k, int from, int to) {
    return std::min(from, static_cast<int>(((std::int64_t{k} + 1) * from + to - 1) / to));
}

// The part of texel n of `from` that lies under texel k of `to`: a whole number; the sum for each k is `from`.
float covered(int n, int k, int from, int to) {
    const std::int64_t begin = std::max(std::int64_t{n} * to, std::int64_t{k} * from);
    const std::int64_t end = std::min((std::int64_t{n} + 1) * to, (std::int64_t{k} + 1) * from);
    return static_cast<float>(std::max<std::int64_t>(0, end - begin));
}

// Computes row j of the averages.
void average_row(const LargerRows& larger, Extent to, int j, float* out) {
    const Extent from = larger.extent;
    if (from.width == 2 * to.width && from.height == 2 * to.height) {
        return average_pairs(larger.row(2 * j), larger.row(2 * j + 1), to.width, out);
    }
    const float area = static_cast<float>(from.width) * static_cast<float>(from.height);
    for (int i = 0; i < to.width; ++i) {
        float sum = 0.0f;
        for (int y = first_covered(j, from.height, to.height); y < last_covered(j, from.height, to.height); ++y) {
            const float weight = covered(y, j, from.height, to.height);
            for (int x = first_covered(i, from.width, to.width); x < last_covered(i, from.width, to.width); ++x) {
                sum += larger.row(y)[x] * (weight * covered(x, i, from.width, to.width));
            }
        }
        out[i] = sum / area;
    }
}

// The memory for a window's normalised averages, and the place of its rows: add_level_row() reads one texel before
// each.
struct Unit {
    static constexpr int kBefore = static_cast<int>(kRowAlignment / sizeof(float));
    Rect window;
    NormalMap map = NormalMap({window.width + 2 * kBefore, window.height});

    NormalRow row(int j) { return {map.x.row(j) + kBefore, map.y.row(j) + kBefore, map.z.row(j) + kBefore}; }
    // Rows of the window; null outside.
    NormalisedRow components(int j) {
        return j < 0 || j >= window.height ? NormalisedRow{} : NormalisedRow{row(j).x, row(j).y};
    }
    void normalise(const NormalMap& averages, int j) {
        constexpr float kAnyZ = -2.0f;
        const NormalRow to = row(j);
        const VectorRow from = row_of(averages, window, j);
        const auto count = static_cast<std::size_t>(window.width);
        std::copy_n(from.x, count, to.x);
        std::copy_n(from.y, count, to.y);
        std::copy_n(from.z, count, to.z);
        finish_vectors(to.x, to.y, to.z, window.width, 0.0f, kAnyZ);
    }
    static VectorRow row_of(const NormalMap& map, const Rect& window, int j) {
        const int y = window.y + j;
        return {map.x.row(y) + window.x, map.y.row(y) + window.x, map.z.row(y) + window.x};
    }
};

constexpr double kLeastTexels = 1024.0;  // of a level that are no background: fewer show nothing

struct WindowSums {
    LevelSums sums;
    double texels = 0.0;
    void add(const WindowSums& other) {
        sums.add(other.sums);
        texels += other.texels;
    }
};

// Calls what(first, count) for each run of texels of a window's row without background in them and beside them. Runs
// start at multiples of kRunStep, so that a row that starts there may be read as far as the whole row may be.
constexpr int kRunStep = 16;  // floats: 64 bytes, see add_level_row()
template <class What>
void each_clean_run(const Plane<float>* background, const Rect& window, int j, What&& what) {
    if (background == nullptr) return what(0, window.width);
    const Extent extent = background->extent();
    const auto is_clean = [&](int i) {
        for (int y = std::max(0, j - 1); y <= std::min(extent.height - 1, j + 1); ++y) {
            for (int x = std::max(0, i - 1); x <= std::min(extent.width - 1, i + 1); ++x) {
                if (background->at(x, y) > 0.0f) return false;
            }
        }
        return true;
    };
    for (int i = 0; i < window.width; ++i) {
        const int first = (i + kRunStep - 1) / kRunStep * kRunStep;
        while (i < window.width && is_clean(window.x + i)) ++i;
        if (i > first) what(first, i - first);
    }
}

// `unit` is for windows of this extent; its values are overwritten.
Result<void> add_window(const Stored& stored, const NormalMap& averages, const Plane<float>* background,
                        const Execution& execution, Unit& unit, WindowSums& all) {
    const Rect& window = unit.window;
    const auto normalise = [&](int begin, int end) {
        for (int j = begin; j < end; ++j) unit.normalise(averages, j);
    };
    if (auto done = parallel_for(execution, window.height, kRowsPerPiece, normalise); !done) return done;
    std::vector<WindowSums> pieces(static_cast<std::size_t>((window.height + kRowsPerPiece - 1) / kRowsPerPiece));
    const auto sum = [&](int begin, int end) {
        NormalMap row(Extent{window.width, 1});
        const NormalRow s{row.x.row(0), row.y.row(0), row.z.row(0)};
        for (int j = begin; j < end; ++j) {
            vectors_of_row(stored, window.y + j, window.x, window.width, s.x, s.y, s.z);
            const VectorRow a = Unit::row_of(averages, window, j);
            const auto from = [](NormalisedRow row, int first) {
                return row.x == nullptr ? row : NormalisedRow{row.x + first, row.y + first};
            };
            WindowSums& piece = pieces[static_cast<std::size_t>(begin / kRowsPerPiece)];
            each_clean_run(background, window, window.y + j, [&](int first, int count) {
                add_level_row({{s.x + first, s.y + first, s.z + first},
                               {a.x + first, a.y + first, a.z + first},
                               from(unit.components(j), first),
                               from(unit.components(j - 1), first),
                               from(unit.components(j + 1), first)},
                              count, piece.sums);
                piece.texels += count;
            });
        }
    };
    if (auto done = parallel_for(execution, window.height, kRowsPerPiece, sum); !done) return done;
    for (const WindowSums& piece : pieces) all.add(piece);
    return {};
}

LevelMeasure measure_of(const LevelSums& sums, double n, bool has_z) {
    LevelMeasure measure;
    const double rr = sums.rr - (sums.r[0] * sums.r[0] + sums.r[1] * sums.r[1]) / n;
    const double ss = sums.ss - (sums.s[0] * sums.s[0] + sums.s[1] * sums.s[1]) / n;
    const double rs = sums.rs - (sums.r[0] * sums.s[0] + sums.r[1] * sums.s[1]) / n;
    measure.signal = std::sqrt(std::max(0.0, rr) / n);
    measure.stored_signal = std::sqrt(std::max(0.0, ss) / n);
    measure.correlation = rr > 0.0 && ss > 0.0 ? rs / std::sqrt(rr * ss) : 0.0;
    measure.gain = sums.rr > 0.0 ? sums.rs / sums.rr : 1.0;
    measure.length = has_z ? sums.length / n : 1.0;
    measure.average_length = sums.average_length / n;
    measure.error_normalised = std::sqrt(sums.normalised_square / n);
    measure.error_average = std::sqrt(sums.average_square / n);
    const double bx = sums.xs - measure.gain * sums.xr, by = sums.ys - measure.gain * sums.yr;
    const double determinant = sums.xx * sums.yy - sums.xy * sums.xy;
    const double gain = std::max(0.1, std::abs(measure.gain));
    if (determinant > 1e-3 * sums.xx * sums.yy && determinant > 0.0) {
        // s(x) = r(x - shift): if s lies to the right, s - r is minus the gradient.
        measure.shift_x = -(sums.yy * bx - sums.xy * by) / determinant / gain;
        measure.shift_y = -(sums.xx * by - sums.xy * bx) / determinant / gain;
    }
    return measure;
}

}  // namespace

void vectors_of_row(const Stored& stored, int j, int first, int count, float* x, float* y, float* z) {
    const auto row_of = [&](Component component) {
        const int channel = stored.channel(component);
        return channel < 0 ? nullptr : stored.image->planes[static_cast<std::size_t>(channel)].row(j) + first;
    };
    const StoredRow row{row_of(Component::x), row_of(Component::y), row_of(Component::z),
                        stored.is_signed ? 1.0f : 2.0f, stored.is_signed ? 0.0f : -1.0f};
    restore_stored_vectors(row, count, x, y, z);
}

Result<NormalMap> averages_of(const NormalMap& larger, const Execution& execution) {
    const Extent to = level_extent(larger.extent(), 1);
    NormalMap map(to);
    const auto body = [&](int begin, int end) {
        for (int j = begin; j < end; ++j) {
            average_row({larger.x, larger.extent(), 0}, to, j, map.x.row(j));
            average_row({larger.y, larger.extent(), 0}, to, j, map.y.row(j));
            average_row({larger.z, larger.extent(), 0}, to, j, map.z.row(j));
        }
    };
    if (auto done = parallel_for(execution, to.height, kRowsPerPiece, body); !done) return done.error();
    return map;
}

Result<NormalMap> base_averages(const Stored& stored, const Execution& execution) {
    const Extent from = stored.extent(), to = level_extent(from, 1);
    NormalMap map(to);
    const auto body = [&](int begin, int end) {
        // Only the rows under one row of the smaller level are in memory: they stay in the processor's cache.
        constexpr int kMostCovered = 3;
        NormalMap rows(Extent{from.width, std::min(from.height, kMostCovered)});
        for (int j = begin; j < end; ++j) {
            const int first = first_covered(j, from.height, to.height), last = last_covered(j, from.height, to.height);
            for (int k = first; k < last; ++k)
                vectors_of_row(stored, k, 0, from.width, rows.x.row(k - first), rows.y.row(k - first),
                               rows.z.row(k - first));
            average_row({rows.x, from, first}, to, j, map.x.row(j));
            average_row({rows.y, from, first}, to, j, map.y.row(j));
            average_row({rows.z, from, first}, to, j, map.z.row(j));
        }
    };
    if (auto done = parallel_for(execution, to.height, kRowsPerPiece, body); !done) return done.error();
    return map;
}

Plane<float> background_share(const Background& background, Extent base) {
    Plane<float> whole(base);
    for (int j = 0; j < base.height; ++j) {
        float* const row = whole.row(j);
        for (int i = 0; i < base.width; ++i) row[i] = background.holds(i, j) ? 1.0f : 0.0f;
    }
    return background_share(whole);
}

Plane<float> background_share(const Plane<float>& larger) {
    Plane<float> share(level_extent(larger.extent(), 1));
    for (int j = 0; j < share.extent().height; ++j)
        average_row({larger, larger.extent(), 0}, share.extent(), j, share.row(j));
    return share;
}

Result<void> measure_level(const Stored& stored, const NormalMap& averages, int level, const Execution& execution,
                           LevelMeasure& measure, const Plane<float>* background) {
    WindowSums all;
    std::optional<Unit> unit;  // new memory for every window would take longer than the window
    for (const Rect& window : sample_windows(stored.extent())) {
        if (unit)
            unit->window = window;  // all have the same extent
        else
            unit.emplace(Unit{window});
        if (auto done = add_window(stored, averages, background, execution, *unit, all); !done) return done;
    }
    measure = background != nullptr && all.texels < kLeastTexels ? LevelMeasure{}
                                                                 : measure_of(all.sums, all.texels, stored.has_z());
    measure.level = level;
    measure.extent = stored.extent();
    return {};
}

}  // namespace tex::inline v1
