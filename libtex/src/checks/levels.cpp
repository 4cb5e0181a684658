// SPDX-License-Identifier: Apache-2.0

#include "checks/levels.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <tex/normal_map.h>

#include "kernels/stored.h"
#include "threads/parallel.h"

namespace tex {
namespace {

constexpr int kRowsPerPiece = 16;

struct Vector {
    float x = 0.0f, y = 0.0f, z = 0.0f;
};

float length_of(const Vector& v) { return std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z); }

Vector normalised(const Vector& v) {
    const float length = length_of(v);
    return length < 1e-6f ? Vector{0.0f, 0.0f, 1.0f} : Vector{v.x / length, v.y / length, v.z / length};
}

Vector at(const NormalMap& map, int i, int j) { return {map.x.at(i, j), map.y.at(i, j), map.z.at(i, j)}; }

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

// Sums over the texels of a level, from which its measures are computed.
struct Sums {
    double count = 0.0;
    double length = 0.0, average_length = 0.0;
    double r[2] = {}, s[2] = {}, rr = 0.0, ss = 0.0, rs = 0.0;  // the squares are sums over both components
    double normalised_square = 0.0, average_square = 0.0;
    // Normal equations of s - g r = d_x r_x + d_y r_y.
    double xx = 0.0, xy = 0.0, yy = 0.0, xr = 0.0, yr = 0.0, xs = 0.0, ys = 0.0;

    void add(const Sums& o) {
        count += o.count;
        length += o.length, average_length += o.average_length;
        for (int c = 0; c < 2; ++c) r[c] += o.r[c], s[c] += o.s[c];
        rr += o.rr, ss += o.ss, rs += o.rs;
        normalised_square += o.normalised_square, average_square += o.average_square;
        xx += o.xx, xy += o.xy, yy += o.yy, xr += o.xr, yr += o.yr, xs += o.xs, ys += o.ys;
    }
};

void add_texel(Sums& sums, const Vector& s, const Vector& r, const Vector& a, bool has_z) {
    sums.count += 1.0;
    sums.length += has_z ? length_of(s) : 1.0;
    sums.average_length += length_of(a);
    const float of_s[2] = {s.x, s.y}, of_r[2] = {r.x, r.y}, of_a[2] = {a.x, a.y};
    for (int c = 0; c < 2; ++c) {
        const double sc = of_s[c], rc = of_r[c];
        sums.s[c] += sc;
        sums.r[c] += rc;
        sums.ss += sc * sc;
        sums.rr += rc * rc;
        sums.rs += sc * rc;
        sums.normalised_square += (sc - rc) * (sc - rc);
        sums.average_square += (sc - of_a[c]) * (sc - of_a[c]);
    }
}

void add_gradients(Sums& sums, const Vector& s, const NormalMap& r, int i, int j) {
    const double of_s[2] = {s.x, s.y};
    const Plane<float>* planes[2] = {&r.x, &r.y};
    for (int c = 0; c < 2; ++c) {
        const Plane<float>& plane = *planes[c];
        const double gx = 0.5 * (static_cast<double>(plane.at(i + 1, j)) - plane.at(i - 1, j));
        const double gy = 0.5 * (static_cast<double>(plane.at(i, j + 1)) - plane.at(i, j - 1));
        sums.xx += gx * gx;
        sums.xy += gx * gy;
        sums.yy += gy * gy;
        sums.xr += gx * plane.at(i, j);
        sums.yr += gy * plane.at(i, j);
        sums.xs += gx * of_s[c];
        sums.ys += gy * of_s[c];
    }
}

// `unit` has the extent of the window; its values are overwritten.
Result<void> add_window(const Stored& stored, const NormalMap& averages, Rect window, const Execution& execution,
                        NormalMap& unit, Sums& all) {
    const auto normalise = [&](int begin, int end) {
        for (int j = begin; j < end; ++j) {
            for (int i = 0; i < window.width; ++i) {
                const Vector r = normalised(at(averages, window.x + i, window.y + j));
                unit.x.at(i, j) = r.x;
                unit.y.at(i, j) = r.y;
                unit.z.at(i, j) = r.z;
            }
        }
    };
    if (auto done = parallel_for(execution, window.height, kRowsPerPiece, normalise); !done) return done;
    std::vector<Sums> pieces(static_cast<std::size_t>((window.height + kRowsPerPiece - 1) / kRowsPerPiece));
    const bool has_z = stored.has_z();
    const auto sum = [&](int begin, int end) {
        Sums& sums = pieces[static_cast<std::size_t>(begin / kRowsPerPiece)];
        NormalMap row(Extent{stored.extent().width, 1});
        for (int j = begin; j < end; ++j) {
            vectors_of_row(stored, window.y + j, row.x.row(0), row.y.row(0), row.z.row(0));
            for (int i = 0; i < window.width; ++i) {
                const Vector s = at(row, window.x + i, 0);
                add_texel(sums, s, at(unit, i, j), at(averages, window.x + i, window.y + j), has_z);
                const bool inner = i > 0 && j > 0 && i + 1 < window.width && j + 1 < window.height;
                if (inner) add_gradients(sums, s, unit, i, j);
            }
        }
    };
    if (auto done = parallel_for(execution, window.height, kRowsPerPiece, sum); !done) return done;
    for (const Sums& piece : pieces) all.add(piece);
    return {};
}

LevelMeasure measure_of(const Sums& sums) {
    LevelMeasure measure;
    const double n = sums.count;
    const double rr = sums.rr - (sums.r[0] * sums.r[0] + sums.r[1] * sums.r[1]) / n;
    const double ss = sums.ss - (sums.s[0] * sums.s[0] + sums.s[1] * sums.s[1]) / n;
    const double rs = sums.rs - (sums.r[0] * sums.s[0] + sums.r[1] * sums.s[1]) / n;
    measure.signal = std::sqrt(std::max(0.0, rr) / n);
    measure.stored_signal = std::sqrt(std::max(0.0, ss) / n);
    measure.correlation = rr > 0.0 && ss > 0.0 ? rs / std::sqrt(rr * ss) : 0.0;
    measure.gain = sums.rr > 0.0 ? sums.rs / sums.rr : 1.0;
    measure.length = sums.length / n;
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

void vectors_of_row(const Stored& stored, int j, float* x, float* y, float* z) {
    const auto row_of = [&](Component component) {
        const int channel = stored.channel(component);
        return channel < 0 ? nullptr : stored.image->planes[static_cast<std::size_t>(channel)].row(j);
    };
    const StoredRow row{row_of(Component::x), row_of(Component::y), row_of(Component::z),
                        stored.is_signed ? 1.0f : 2.0f, stored.is_signed ? 0.0f : -1.0f};
    restore_stored_vectors(row, stored.extent().width, x, y, z);
}

NormalMap averages_of(const NormalMap& larger) {
    const Extent to = level_extent(larger.extent(), 1);
    NormalMap map(to);
    for (int j = 0; j < to.height; ++j) {
        average_row({larger.x, larger.extent(), 0}, to, j, map.x.row(j));
        average_row({larger.y, larger.extent(), 0}, to, j, map.y.row(j));
        average_row({larger.z, larger.extent(), 0}, to, j, map.z.row(j));
    }
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
                vectors_of_row(stored, k, rows.x.row(k - first), rows.y.row(k - first), rows.z.row(k - first));
            average_row({rows.x, from, first}, to, j, map.x.row(j));
            average_row({rows.y, from, first}, to, j, map.y.row(j));
            average_row({rows.z, from, first}, to, j, map.z.row(j));
        }
    };
    if (auto done = parallel_for(execution, to.height, kRowsPerPiece, body); !done) return done.error();
    return map;
}

Result<void> measure_level(const Stored& stored, const NormalMap& averages, int level, const Execution& execution,
                           LevelMeasure& measure) {
    Sums all;
    NormalMap unit;  // new memory for every window would take longer than the window
    for (const Rect& window : sample_windows(stored.extent())) {
        const Extent extent{window.width, window.height};
        if (unit.extent() != extent) unit = NormalMap(extent);
        if (auto done = add_window(stored, averages, window, execution, unit, all); !done) return done;
    }
    measure = measure_of(all);
    measure.level = level;
    measure.extent = stored.extent();
    return {};
}

}  // namespace tex
