// SPDX-License-Identifier: Apache-2.0

#include "kernels/angle_search.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "blocks/bc1.h"
#include "blocks/bc4.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/angle_search.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "kernels/dispatch.h"

#ifndef TEX_ANGLE_SEARCH_ONCE
#define TEX_ANGLE_SEARCH_ONCE
namespace tex::inline v1 {
namespace {

// One channel of a block: its endpoints in the order in which they are stored. Endpoints of snorm are 0 to 254.
struct Ends {
    HalfKind kind;
    int e[2];
};

struct Palette {
    int count;
    float values[8];  // components, in the order of indices
};

int most_code(HalfKind kind) { return kind == HalfKind::green ? 63 : kind == HalfKind::bc4_unorm ? 255 : 254; }

int steps_of(const Ends& ends) { return ends.kind == HalfKind::green ? 3 : ends.e[0] > ends.e[1] ? 7 : 5; }

Palette palette_of(const Ends& ends) {
    const int steps = steps_of(ends);
    const bool green = ends.kind == HalfKind::green;
    const int top = ends.kind == HalfKind::bc4_snorm ? 254 : 255;
    const int e0 = green ? widen_green(ends.e[0]) : ends.e[0];
    const int e1 = green ? widen_green(ends.e[1]) : ends.e[1];
    const auto component = [&](int k) {  // (steps - k) e0 + k e1, of `steps`
        return static_cast<float>(2 * ((steps - k) * e0 + k * e1)) / static_cast<float>(steps * top) - 1.0f;
    };
    Palette palette{green ? 4 : 8, {component(0), component(steps)}};
    for (int k = 1; k < steps; ++k) palette.values[k + 1] = component(k);
    if (steps == 5) palette.values[6] = -1.0f, palette.values[7] = 1.0f;
    // If the greens are equal, only index 0 is used.
    if (green && e0 == e1) palette.count = 1;
    return palette;
}

std::uint64_t load_bytes(const std::byte* from, int count) {
    std::uint64_t value = 0;
    for (int k = 0; k < count; ++k) value |= std::to_integer<std::uint64_t>(from[k]) << (8 * k);
    return value;
}

void store_bytes(std::uint64_t value, int count, std::byte* to) {
    for (int k = 0; k < count; ++k) to[k] = static_cast<std::byte>(value >> (8 * k));
}

Ends load_ends(HalfKind kind, const std::byte* block) {
    if (kind == HalfKind::green) {
        const auto colors = static_cast<int>(load_bytes(block, 4) & 0x7FFFFFFF);
        return {kind, {colors >> 5 & 63, colors >> 21 & 63}};
    }
    const int e0 = std::to_integer<int>(block[0]);
    const int e1 = std::to_integer<int>(block[1]);
    if (kind == HalfKind::bc4_unorm) return {kind, {e0, e1}};
    return {kind, {static_cast<std::int8_t>(e0) + 127, static_cast<std::int8_t>(e1) + 127}};
}

void store_channel(const Ends& ends, const int* indices, std::byte* block) {
    const int bits = ends.kind == HalfKind::green ? 2 : 3;
    std::uint64_t packed = 0;
    for (int k = 0; k < 16; ++k) packed |= static_cast<std::uint64_t>(indices[k]) << (bits * k);
    if (ends.kind == HalfKind::green) {
        const auto word = [](int green) { return static_cast<std::uint64_t>(31 << 11 | green << 5 | 31); };
        store_bytes(word(ends.e[0]) | word(ends.e[1]) << 16 | packed << 32, 8, block);
    } else {
        const int bias = ends.kind == HalfKind::bc4_snorm ? 127 : 0;
        const auto byte = [&](int code) { return static_cast<std::uint64_t>(static_cast<std::uint8_t>(code - bias)); };
        store_bytes(byte(ends.e[0]) | byte(ends.e[1]) << 8 | packed << 16, 8, block);
    }
}

// Whether the channel may have these endpoints; the type of palette must not change.
bool allowed(const Ends& before, const Ends& after) {
    const int most = most_code(after.kind);
    if (std::min(after.e[0], after.e[1]) < 0 || std::max(after.e[0], after.e[1]) > most) return false;
    return after.kind == HalfKind::green ? after.e[0] >= after.e[1] : steps_of(before) == steps_of(after);
}

}  // namespace
}  // namespace tex::inline v1
#endif

HWY_BEFORE_NAMESPACE();
namespace tex::inline v1 {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::CappedTag<float, 16>;
using F = hn::Vec<Floats>;

// The normals of a block's texels. Texels outside the level have weight 0.
struct Normals {
    HWY_ALIGN float x[16], y[16], z[16], weight[16];
};

// The unit vectors of all pairs of values: that of a and b at a + 8 b.
struct AnglePairs {
    HWY_ALIGN float x[64], y[64], z[64];
};
void make_pairs(const Palette& px, const Palette& py, AnglePairs& pairs) {
    const hn::CappedTag<float, 8> d;
    const auto one = hn::Set(d, 1.0f);
    for (int b = 0; b < py.count; ++b) {
        const auto my = hn::Set(d, py.values[b]);
        for (int a = 0; a < 8; a += static_cast<int>(hn::Lanes(d))) {
            const auto mx = hn::LoadU(d, px.values + a);
            const auto flat = hn::Add(hn::Mul(mx, mx), hn::Mul(my, my));
            // Readers make vectors unit.
            const auto is_long = hn::Gt(flat, one);
            auto factor = one;
            if (!hn::AllFalse(d, is_long)) factor = hn::IfThenElse(is_long, hn::Div(one, hn::Sqrt(flat)), one);
            hn::Store(hn::Mul(factor, mx), d, pairs.x + 8 * b + a);
            hn::Store(hn::Mul(factor, my), d, pairs.y + 8 * b + a);
            hn::Store(hn::Sqrt(hn::Sub(one, hn::Min(one, flat))), d, pairs.z + 8 * b + a);
        }
    }
}

// Returns the sum over the texels. If `pairs` is not null, stores the best pair of indices for each texel there, as
// index of x + 8 * index of y.
float measure(const Normals& n, const Ends& x_ends, const Ends& y_ends, int* pairs) {
    const Floats d;
    const Palette px = palette_of(x_ends);
    const Palette py = palette_of(y_ends);
    AnglePairs all;
    make_pairs(px, py, all);
    HWY_ALIGN float chords[16];
    HWY_ALIGN float best[16];
    for (int i = 0; i < 16; i += static_cast<int>(hn::Lanes(d))) {
        const F x = hn::Load(d, n.x + i);
        const F y = hn::Load(d, n.y + i);
        const F z = hn::Load(d, n.z + i);
        F least = hn::Set(d, 1e9f);
        F pair = hn::Zero(d);
        for (int k = 0; k < 8 * py.count; ++k) {
            if (k % 8 >= px.count) continue;
            const F dx = hn::Sub(x, hn::Set(d, all.x[k]));
            const F dy = hn::Sub(y, hn::Set(d, all.y[k]));
            const F dz = hn::Sub(z, hn::Set(d, all.z[k]));
            const F chord = hn::Add(hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy)), hn::Mul(dz, dz));
            if (pairs != nullptr) pair = hn::IfThenElse(hn::Lt(chord, least), hn::Set(d, static_cast<float>(k)), pair);
            least = hn::Min(least, chord);
        }
        hn::Store(hn::Mul(least, hn::Load(d, n.weight + i)), d, chords + i);
        hn::Store(pair, d, best + i);
    }
    float sum = 0.0f;
    for (int k = 0; k < 16; ++k) {
        sum += chords[k];
        if (pairs != nullptr) pairs[k] = static_cast<int>(best[k]);
    }
    return sum;
}

// Takes the step with the greatest gain among all that change the endpoints of one channel by up to `reach` codes.
// Returns false if no step gains.
bool take_step(const Normals& n, int reach, Ends (&ends)[2], float& sum) {
    constexpr int kMoves[8][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, -1}, {1, -1}, {-1, 1}};
    const Ends before[2] = {ends[0], ends[1]};
    bool gained = false;
    for (int channel = 0; channel < 2; ++channel) {
        for (int distance = 1; distance <= reach; ++distance) {
            for (const auto& move : kMoves) {
                Ends moved[2] = {before[0], before[1]};
                moved[channel].e[0] += distance * move[0];
                moved[channel].e[1] += distance * move[1];
                if (!allowed(before[channel], moved[channel])) continue;
                const float moved_sum = measure(n, moved[0], moved[1], nullptr);
                if (!(moved_sum < sum)) continue;
                sum = moved_sum;
                ends[0] = moved[0];
                ends[1] = moved[1];
                gained = true;
            }
        }
    }
    return gained;
}

void improve_angles(const BlockRow& row, const HalfKind kinds[2], int reach, std::byte* blocks) {
    for (int block = 0; block < blocks_across(row.width); ++block) {
        Normals n;
        for (int k = 0; k < 16; ++k) {
            const int i = std::min(kBlockEdge * block + k % kBlockEdge, row.width - 1);
            const float y = row.y[k / kBlockEdge][i];
            n.x[k] = std::clamp(row.x[k / kBlockEdge][i], -1.0f, 1.0f);
            n.y[k] = std::clamp(row.negate_y ? -y : y, -1.0f, 1.0f);
            const float flat = n.x[k] * n.x[k] + n.y[k] * n.y[k];
            const float factor = 1.0f / std::sqrt(std::max(1.0f, flat));
            n.x[k] *= factor;
            n.y[k] *= factor;
            n.z[k] = std::sqrt(1.0f - std::min(1.0f, flat));
            const bool inside = kBlockEdge * block + k % kBlockEdge < row.width && k / kBlockEdge < row.height;
            n.weight[k] = inside ? 1.0f : 0.0f;
        }
        std::byte* bytes = blocks + 16 * static_cast<std::ptrdiff_t>(block);
        Ends ends[2] = {load_ends(kinds[0], bytes), load_ends(kinds[1], bytes + 8)};
        float sum = measure(n, ends[0], ends[1], nullptr);
        while (take_step(n, reach, ends, sum)) {
        }
        int pairs[16], x_indices[16], y_indices[16];
        measure(n, ends[0], ends[1], pairs);
        for (int k = 0; k < 16; ++k) {
            x_indices[k] = pairs[k] % 8;
            y_indices[k] = pairs[k] / 8;
        }
        store_channel(ends[0], x_indices, bytes);
        store_channel(ends[1], y_indices, bytes + 8);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace tex::inline v1
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tex::inline v1 {

TEX_KERNEL(void, improve_angles, improve_angles,
           (const BlockRow& row, const HalfKind kinds[2], int reach, std::byte* blocks), (row, kinds, reach, blocks))

}  // namespace tex::inline v1
#endif  // HWY_ONCE
