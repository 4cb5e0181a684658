// SPDX-License-Identifier: Apache-2.0

#include <cmath>

#include <tex/blend.h>

#include "c/call.h"
#include "kernels/angle.h"
#include "kernels/blend.h"
#include "kernels/scale.h"
#include "rows/whole_vectors.h"

namespace tex::inline v1 {
namespace {

constexpr int kBlendChunk = 256;  // texels that are blended together, on the stack

void blend_chunk(const NormalRow& base, const NormalRow& detail, const float* weight, BlendMode mode, int first,
                 int count, const NormalRow& out) {
    float rows[7][kBlendChunk] = {};
    const float* const from[] = {base.x, base.y, base.z, detail.x, detail.y, detail.z};
    for (int k = 0; k < 6; ++k) std::copy_n(from[k] + first, count, rows[k]);
    if (weight != nullptr) {
        for (int i = 0; i < count; ++i) rows[6][i] = std::clamp(weight[first + i], 0.0f, 1.0f);
    }
    blend_row(mode, {rows[0], rows[1], rows[2]}, {rows[3], rows[4], rows[5]}, weight == nullptr ? nullptr : rows[6],
              count);
    float* const to[] = {out.x, out.y, out.z};
    for (int k = 0; k < 3; ++k) std::copy_n(rows[k], count, to[k] + first);
}

}  // namespace
}  // namespace tex::inline v1

using namespace tex;

int32_t tex_scale(const tex_map* map, float scale, int32_t mode, int32_t first, int32_t end, const tex_map* out) {
    if (!is_map(map) || !is_map(out) || !same_extent(*map, *out) || !are_rows(first, end, map->height))
        return TEX_BAD_ARGUMENT;
    if (!std::isfinite(scale) || std::abs(scale) > kMaxScale || !is_one_of(mode, kScaleModeNames))
        return TEX_BAD_OPTION;
    for (int j = first; j < end; ++j) {
        const NormalRow row = row_of(*map, j), made = row_of(*out, j);
        const float* const from[] = {row.x, row.y, row.z};
        float* const to[] = {made.x, made.y, made.z};
        in_whole_vectors(map->width, from, to, [&](const float* const* n, float* const* s, int count) {
            scale_row({n[0], n[1], n[2]}, scale, static_cast<ScaleMode>(mode), count, {s[0], s[1], s[2]});
        });
    }
    return TEX_OK;
}

int32_t tex_blend(const tex_map* base, const tex_map* detail, const tex_plane* weight, int32_t mode, int32_t first,
                  int32_t end, const tex_map* out) {
    if (!is_map(base) || !is_map(detail) || !is_map(out) || !same_extent(*base, *detail) || !same_extent(*base, *out) ||
        !are_rows(first, end, base->height))
        return TEX_BAD_ARGUMENT;
    if (weight != nullptr && (!is_plane(weight) || !same_extent(*base, *weight))) return TEX_BAD_ARGUMENT;
    if (!is_one_of(mode, kBlendModeNames)) return TEX_BAD_OPTION;
    for (int j = first; j < end; ++j) {
        const float* const weights = weight == nullptr ? nullptr : row_of(*weight, j);
        for (int i = 0; i < base->width; i += kBlendChunk) {
            blend_chunk(row_of(*base, j), row_of(*detail, j), weights, static_cast<BlendMode>(mode), i,
                        std::min(kBlendChunk, base->width - i), row_of(*out, j));
        }
    }
    return TEX_OK;
}

int32_t tex_angles(const tex_map* a, const tex_map* b, int32_t first, int32_t end, const tex_plane* degrees) {
    if (!is_map(a) || !is_map(b) || !is_plane(degrees) || !same_extent(*a, *b) || !same_extent(*a, *degrees) ||
        !are_rows(first, end, a->height))
        return TEX_BAD_ARGUMENT;
    for (int j = first; j < end; ++j) {
        const NormalRow p = row_of(*a, j), q = row_of(*b, j);
        const float* const from[] = {p.x, p.y, p.z, q.x, q.y, q.z};
        float* const to[] = {row_of(*degrees, j)};
        in_whole_vectors(a->width, from, to, [](const float* const* n, float* const* angles, int count) {
            angle_row({n[0], n[1], n[2]}, {n[3], n[4], n[5]}, count, angles[0]);
        });
    }
    return TEX_OK;
}
