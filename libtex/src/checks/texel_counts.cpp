// SPDX-License-Identifier: Apache-2.0

#include "checks/texel_counts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <tex/normal_map.h>

#include "threads/parallel.h"

namespace tex {
namespace {

constexpr int kRowsPerPiece = 16;
constexpr float kCodeAndHalf = 1.5f / 255.0f;
constexpr float kBehind = -0.1f;
constexpr float kBeyond = 1.0f + kTwoCodes;
constexpr float kBeyondOfBlocks = 1.3f;

// The contribution of one row to the counts.
struct RowCounts {
    std::array<std::int64_t, kPropertyCount> count{};
    std::array<int, kPropertyCount> first{};
    std::int64_t finite = 0;
    double x = 0.0, y = 0.0, z = 0.0, length = 0.0;
    float min_length = std::numeric_limits<float>::max(), max_length = 0.0f;
    std::array<float, 4> low, high;
    double a = 0.0, m = 0.0, aa = 0.0, mm = 0.0, am = 0.0;

    RowCounts() {
        low.fill(std::numeric_limits<float>::max());
        high.fill(std::numeric_limits<float>::lowest());
    }
    void mark(Property p, bool holds, int column) {
        if (!holds) return;
        const auto k = static_cast<std::size_t>(p);
        if (count[k]++ == 0) first[k] = column;
    }
};

// The positions of the channels of a row, and their meaning.
struct RowView {
    std::array<const float*, 4> channel{};
    const float *x = nullptr, *y = nullptr, *z = nullptr;
    int channels = 0;
    float scale = 2.0f, offset = -1.0f;  // from a stored value to a component
    float beyond = kBeyond * kBeyond;
    bool colors = false;  // R, G, B and A all exist, and A is not a component
    bool one_in_red = false;
    bool alpha_free = false;
    float low_flat = 2.0f, high_flat = 2.0f;  // codes 127 and 128, if the format has them
};

// Counts by the components and their length. A separate function, so that its values stay in registers.
template <bool kHasZ>
void count_vectors(const RowView& view, int width, RowCounts& row) {
    constexpr float kLong = (1.0f + kTwoCodes) * (1.0f + kTwoCodes), kShort = (1.0f - kTwoCodes) * (1.0f - kTwoCodes);
    constexpr float kNull = kNullLength * kNullLength;
    for (int i = 0; i < width; ++i) {
        const float x = view.x[i] * view.scale + view.offset, y = view.y[i] * view.scale + view.offset;
        const float flat = x * x + y * y;
        const float z = kHasZ ? view.z[i] * view.scale + view.offset : reconstruct_z(x, y);
        const float square = flat + z * z;
        if (!(square < std::numeric_limits<float>::max())) {  // also if NaN
            row.mark(Property::not_finite, true, i);
            continue;
        }
        row.mark(Property::beyond_unit, flat > view.beyond, i);
        if constexpr (kHasZ) {
            row.mark(Property::null_vector, square < kNull, i);
            row.mark(Property::off_length, square > kLong || square < kShort, i);
            row.mark(Property::z_below, z < -kTwoCodes, i);
            row.mark(Property::z_behind, z < kBehind, i);
        }
        const bool low = view.x[i] == view.low_flat && view.y[i] == view.low_flat;
        const bool high = view.x[i] == view.high_flat && view.y[i] == view.high_flat;
        row.mark(Property::flat_low, low, i);
        row.mark(Property::flat_high, high, i);
        const float length = std::sqrt(square);
        ++row.finite;
        row.x += x;
        row.y += y;
        row.z += z;
        row.length += length;
        row.min_length = std::min(row.min_length, length);
        row.max_length = std::max(row.max_length, length);
    }
}

void count_colors(const RowView& view, int width, RowCounts& row) {
    for (std::size_t c = 0; c < static_cast<std::size_t>(view.channels); ++c) {
        float low = row.low[c], high = row.high[c];
        for (int i = 0; i < width; ++i) {
            low = std::min(low, view.channel[c][i]);
            high = std::max(high, view.channel[c][i]);
        }
        row.low[c] = low;
        row.high[c] = high;
    }
    if (view.one_in_red) {
        for (int i = 0; i < width; ++i) row.mark(Property::red_not_one, view.channel[0][i] < 1.0f, i);
    }
    if (view.alpha_free) {
        for (int i = 0; i < width; ++i) row.mark(Property::alpha_not_one, view.channel[3][i] < 1.0f, i);
    }
    if (view.channels >= 3 && view.z != nullptr) {
        const float *r = view.channel[0], *g = view.channel[1], *b = view.channel[2];
        for (int i = 0; i < width; ++i) {
            row.mark(Property::grey, std::abs(r[i] - g[i]) <= kCodeAndHalf && std::abs(g[i] - b[i]) <= kCodeAndHalf, i);
        }
    }
    if (!view.colors) return;
    for (int i = 0; i < width; ++i) {
        const double m = std::max({view.channel[0][i], view.channel[1][i], view.channel[2][i]}), a = view.channel[3][i];
        row.mark(Property::above_alpha, m > a + static_cast<double>(kCodeAndHalf), i);
        row.a += a;
        row.m += m;
        row.aa += a * a;
        row.mm += m * m;
        row.am += a * m;
    }
}

RowView view_of(const Stored& stored, int j) {
    const Image& image = *stored.image;
    RowView view;
    view.channels = static_cast<int>(std::min<std::size_t>(image.planes.size(), 4));
    for (std::size_t c = 0; c < static_cast<std::size_t>(view.channels); ++c) view.channel[c] = image.planes[c].row(j);
    const auto row_of = [&](Component component) {
        const int channel = stored.channel(component);
        return channel < 0 ? nullptr : view.channel[static_cast<std::size_t>(channel)];
    };
    view.x = row_of(Component::x);
    view.y = row_of(Component::y);
    view.z = row_of(Component::z);
    if (stored.in_blocks) view.beyond = kBeyondOfBlocks * kBeyondOfBlocks;
    if (stored.is_signed) {
        view.scale = 1.0f;
        view.offset = 0.0f;
    }
    const bool alpha_is_x = stored.channel(Component::x) == 3;
    view.one_in_red = alpha_is_x && view.z == nullptr;
    view.alpha_free = view.channels == 4 && !alpha_is_x;
    view.colors = view.alpha_free && view.z != nullptr && !stored.is_signed;
    if (image.sample == SampleKind::unorm && image.bits == 8) {
        view.low_flat = 127.0f / 255.0f;
        view.high_flat = 128.0f / 255.0f;
    }
    return view;
}

double correlation(double n, double a, double b, double aa, double bb, double ab) {
    if (n <= 0.0) return 0.0;
    const double va = aa - a * a / n, vb = bb - b * b / n;
    return va > 1e-9 * n && vb > 1e-9 * n ? (ab - a * b / n) / std::sqrt(va * vb) : 0.0;
}

TexelCounts combine(const std::vector<RowCounts>& rows, Extent extent) {
    TexelCounts counts;
    counts.texels = extent.texels();
    RowCounts all;
    for (std::size_t j = 0; j < rows.size(); ++j) {
        const RowCounts& row = rows[j];
        for (std::size_t k = 0; k < row.count.size(); ++k) {
            counts.tally[k].add_row(row.count[k], row.first[k], static_cast<int>(j));
        }
        all.finite += row.finite;
        all.x += row.x;
        all.y += row.y;
        all.z += row.z;
        all.length += row.length;
        all.min_length = std::min(all.min_length, row.min_length);
        all.max_length = std::max(all.max_length, row.max_length);
        for (std::size_t c = 0; c < 4; ++c) {
            all.low[c] = std::min(all.low[c], row.low[c]);
            all.high[c] = std::max(all.high[c], row.high[c]);
        }
        all.a += row.a;
        all.m += row.m;
        all.aa += row.aa;
        all.mm += row.mm;
        all.am += row.am;
    }
    const double finite = std::max(1.0, static_cast<double>(all.finite));
    counts.finite = all.finite;
    counts.mean_x = all.x / finite;
    counts.mean_y = all.y / finite;
    counts.mean_z = all.z / finite;
    counts.mean_length = all.length / finite;
    counts.min_length = all.finite > 0 ? all.min_length : 0.0f;
    counts.max_length = all.max_length;
    counts.low = all.low;
    counts.high = all.high;
    counts.alpha_correlation = correlation(static_cast<double>(counts.texels), all.a, all.m, all.aa, all.mm, all.am);
    return counts;
}

}  // namespace

Result<TexelCounts> count_texels(const Stored& stored, const Execution& execution) {
    const Extent extent = stored.extent();
    std::vector<RowCounts> rows(static_cast<std::size_t>(extent.height));
    const auto body = [&](int begin, int end) {
        for (int j = begin; j < end; ++j) {
            const RowView view = view_of(stored, j);
            RowCounts& row = rows[static_cast<std::size_t>(j)];
            if (view.z != nullptr) {
                count_vectors<true>(view, extent.width, row);
            } else {
                count_vectors<false>(view, extent.width, row);
            }
            count_colors(view, extent.width, row);
        }
    };
    if (auto done = parallel_for(execution, extent.height, kRowsPerPiece, body); !done) return done.error();
    return combine(rows, extent);
}

}  // namespace tex
