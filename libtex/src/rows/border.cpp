// SPDX-License-Identifier: Apache-2.0

#include "rows/border.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "kernels/bake.h"
#include "rows/whole_vectors.h"

namespace tex::inline v1 {
namespace {

int mirrored(int i, int n) {
    const int r = wrap_around(i, 2 * n);
    return r < n ? r : 2 * n - 1 - r;
}

// The height that lies `distance` >= 1 texels beyond the border at texel 0; the texels are 0 to last.
HeightIndex beyond_first(int distance, int last) {
    const int turns = (distance - 1) / (2 * last);  // pairs of half turns before the last one or two
    const int rest = distance - 2 * last * turns;   // 1 to 2 last
    if (rest > last) return {2 * last - rest, 0, last, 2 * turns + 2, false};
    return {rest, 0, turns == 0 ? 0 : last, 2 * turns, true};
}

float height_at(const float* row, HeightIndex at) {
    if (at.plain()) return row[at.index];
    const float base = at.reflected ? 2.0f * row[at.edge] - row[at.index] : row[at.index];
    return base + static_cast<float>(at.drift) * (row[at.edge] - row[at.other]);
}

}  // namespace

int border_index(Wrap wrap, int i, int n) {
    switch (wrap) {
        case Wrap::repeat: return wrap_around(i, n);
        case Wrap::clamp: return std::clamp(i, 0, n - 1);
        case Wrap::mirror: return mirrored(i, n);
    }
    return 0;
}

HeightIndex height_index(Wrap wrap, int i, int n) {
    const int last = n - 1;
    if (i >= 0 && i <= last) return {i, 0, 0, 0, false};
    if (wrap != Wrap::clamp || last == 0) return {border_index(wrap, i, n), 0, 0, 0, false};
    if (i < 0) return beyond_first(-i, last);
    // The other end behaves the same way, as seen from that end.
    const HeightIndex seen = beyond_first(i - last, last);
    return {last - seen.index, last, last - seen.other, seen.drift, seen.reflected};
}

const float* height_row(const RowOf& heights, Extent extent, Wrap wrap, int j, float* beyond) {
    const HeightIndex at = height_index(wrap, j, extent.height);
    if (at.plain()) return heights(at.index);
    continue_heights(heights(at.index), heights(at.edge), heights(at.other), at.reflected, static_cast<float>(at.drift),
                     1.0f, extent.width, beyond);
    return beyond;
}

int aligned_count(int count) {
    constexpr int kStep = static_cast<int>(kRowAlignment / sizeof(float));
    return (count + kStep - 1) / kStep * kStep;
}

HeightRows::HeightRows(Extent extent, RowOf heights, Wrap wrap_x, Wrap wrap_y, int apron, int kept, float scale)
    : extent_(extent), heights_(std::move(heights)), wrap_x_(wrap_x), wrap_y_(wrap_y), apron_(apron), kept_(kept),
      scale_(scale), lead_(aligned_count(apron)), rows_(Extent{lead_ + extent.width + lead_, kept}, 0.0f) {}

HeightRows::HeightRows(PlaneView<const float> heights, Wrap wrap_x, Wrap wrap_y, int apron, int kept)
    : HeightRows(
          heights.extent, [data = heights.data, stride = heights.stride](int j) { return data + j * stride; }, wrap_x,
          wrap_y, apron, kept) {}

const float* HeightRows::row(int j) const { return rows_.row(wrap_around(j, kept_)) + lead_; }

const float* HeightRows::fetch(int j) {
    const int width = extent_.width;
    float* out = rows_.row(wrap_around(j, kept_)) + lead_;
    const HeightIndex at = height_index(wrap_y_, j, extent_.height);
    float* const to[] = {out};
    if (at.plain()) {
        const float* const from[] = {heights_(at.index)};
        in_whole_vectors(width, from, to, [this](const float* const* row, float* const* limited, int count) {
            limit_heights(row[0], scale_, count, limited[0]);
        });
    } else {
        const float* const from[] = {heights_(at.index), heights_(at.edge), heights_(at.other)};
        in_whole_vectors(width, from, to, [this, at](const float* const* row, float* const* beyond, int count) {
            continue_heights(row[0], row[1], row[2], at.reflected, static_cast<float>(at.drift), scale_, count,
                             beyond[0]);
        });
    }
    for (int k = 1; k <= apron_; ++k) {
        const float left = height_at(out, height_index(wrap_x_, -k, width));
        const float right = height_at(out, height_index(wrap_x_, width - 1 + k, width));
        out[-k] = left;
        out[width - 1 + k] = right;
    }
    return out;
}

}  // namespace tex::inline v1
