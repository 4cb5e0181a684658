// SPDX-License-Identifier: Apache-2.0

#include "checks/texel_counts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "kernels/stored.h"
#include "threads/parallel.h"

namespace tex::inline v1 {
namespace {

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
    // Counts the columns for which holds(column) is true. The loop has no branches, so that compilers use vectors.
    template <class Holds>
    void mark(Property p, int width, const Holds& holds) {
        int found = 0;
        for (int i = 0; i < width; ++i) found += holds(i) ? 1 : 0;
        if (found == 0) return;
        const auto k = static_cast<std::size_t>(p);
        count[k] = found;
        while (!holds(first[k])) ++first[k];
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

    // Precondition: there are three channels.
    [[nodiscard]] bool is_grey(int i) const {
        const float *r = channel[0], *g = channel[1], *b = channel[2];
        const bool red_is = std::abs(r[i] - g[i]) <= kCodeAndHalf, blue_is = std::abs(g[i] - b[i]) <= kCodeAndHalf;
        return red_is && blue_is;
    }
};

// Where each VectorTrait is counted.
constexpr Property kProperties[kVectorTraits] = {
    Property::not_finite, Property::beyond_unit, Property::null_vector, Property::off_length,
    Property::z_below,    Property::z_behind,    Property::flat_low,    Property::flat_high,
};

// Counts by the components and their length.
void count_vectors(const RowView& view, int width, RowCounts& row) {
    constexpr float kLong = 1.0f + kTwoCodes, kShort = 1.0f - kTwoCodes;
    const VectorLimits limits{
        view.beyond,   kNullLength * kNullLength, kShort * kShort, kLong * kLong, -kTwoCodes, kBehind, view.low_flat,
        view.high_flat};
    VectorCounts counts;
    count_stored_vectors({view.x, view.y, view.z, view.scale, view.offset}, limits, width, counts);
    for (std::size_t k = 0; k < kVectorTraits; ++k) {
        const auto property = static_cast<std::size_t>(kProperties[k]);
        row.count[property] = counts.count[k];
        row.first[property] = counts.first[k];
    }
    row.finite = counts.finite;
    row.x = counts.x;
    row.y = counts.y;
    row.z = counts.z;
    row.length = counts.length;
    row.min_length = counts.min_length;
    row.max_length = counts.max_length;
}

void count_colors(const RowView& view, int width, RowCounts& row) {
    for (std::size_t c = 0; c < static_cast<std::size_t>(view.channels); ++c)
        widen_range(view.channel[c], width, row.low[c], row.high[c]);
    const float *r = view.channel[0], *g = view.channel[1], *b = view.channel[2], *alpha = view.channel[3];
    if (view.one_in_red && row.low[0] < 1.0f)
        row.mark(Property::red_not_one, width, [r](int i) { return r[i] < 1.0f; });
    if (view.alpha_free && row.low[3] < 1.0f)
        row.mark(Property::alpha_not_one, width, [alpha](int i) { return alpha[i] < 1.0f; });
    if (view.channels >= 3 && view.z != nullptr) {
        row.mark(Property::grey, width, [&view](int i) { return view.is_grey(i); });
    }
    if (!view.colors) return;
    const auto brightest = [r, g, b](int i) { return std::max(std::max(r[i], g[i]), b[i]); };
    row.mark(Property::above_alpha, width, [=](int i) {
        return static_cast<double>(brightest(i)) > static_cast<double>(alpha[i]) + static_cast<double>(kCodeAndHalf);
    });
    for (int i = 0; i < width; ++i) {
        const double m = brightest(i), a = alpha[i];
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
    view.alpha_free = view.channels == 4 && !alpha_is_x && stored.channel(Component::y) != 3;
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

// Counts the vectors of row j without those of the background, which are NaN meanwhile.
void count_others(const Background& background, int j, RowView view, int width, RowCounts& row) {
    std::vector<float> x(view.x, view.x + width);
    int masked = 0;
    for (int i = 0; i < width; ++i) {
        if (!background.holds(i, j)) continue;
        x[static_cast<std::size_t>(i)] = std::numeric_limits<float>::quiet_NaN();
        ++masked;
    }
    const float* const stored_x = view.x;
    view.x = x.data();
    count_vectors(view, width, row);
    const auto not_finite = static_cast<std::size_t>(Property::not_finite);
    row.count[not_finite] -= masked;
    if (row.count[not_finite] == 0) return;
    int& first = row.first[not_finite];
    const auto is_finite = [&](int i) {
        return std::isfinite(stored_x[i] + view.y[i] + (view.z != nullptr ? view.z[i] : 0.0f));
    };
    for (first = 0; first + 1 < width && is_finite(first);) ++first;
}

void leave_out_grey(const Background& background, int j, const RowView& view, int width, RowCounts& row) {
    std::int64_t& grey = row.count[static_cast<std::size_t>(Property::grey)];
    for (int i = 0; i < width && grey > 0; ++i) grey -= background.holds(i, j) && view.is_grey(i) ? 1 : 0;
}

TexelCounts combine(const std::vector<RowCounts>& rows, Extent extent, std::int64_t masked) {
    TexelCounts counts;
    counts.texels = extent.texels() - masked;
    counts.all = extent.texels();
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
    counts.alpha_correlation = correlation(static_cast<double>(extent.texels()), all.a, all.m, all.aa, all.mm, all.am);
    return counts;
}

}  // namespace

Result<TexelCounts> count_texels(const Stored& stored, const Execution& execution, const Background* background) {
    const Extent extent = stored.extent();
    std::vector<RowCounts> rows(static_cast<std::size_t>(extent.height));
    const auto body = [&](int begin, int end) {
        for (int j = begin; j < end; ++j) {
            const RowView view = view_of(stored, j);
            RowCounts& row = rows[static_cast<std::size_t>(j)];
            if (background == nullptr)
                count_vectors(view, extent.width, row);
            else
                count_others(*background, j, view, extent.width, row);
            count_colors(view, extent.width, row);
            if (background != nullptr) leave_out_grey(*background, j, view, extent.width, row);
        }
    };
    if (auto done = parallel_for(execution, extent.height, kRowsPerPiece, body); !done) return done.error();
    return combine(rows, extent, background == nullptr ? 0 : background->masked);
}

}  // namespace tex::inline v1
