// SPDX-License-Identifier: Apache-2.0

#include "kernels/uastc_hints.h"

#include "blocks/uastc_write.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/uastc_hints.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "kernels/bc7_lanes-inl.h"
#include "kernels/dispatch.h"

HWY_BEFORE_NAMESPACE();
namespace tex::inline v1 {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

constexpr int kEtc1Tables = 8;
constexpr float kEtc1Modifiers[kEtc1Tables][2] = {{2, 8},   {5, 17},  {9, 29},   {13, 42},
                                                  {18, 60}, {24, 80}, {33, 106}, {47, 183}};

// What a bias adds to the red, green and blue of the first and of the second base colour, in steps of their codes.
struct Etc1Bias {
    float of[2][3];
};
constexpr int kEtc1Biases = 32;
constexpr Etc1Bias etc1_bias(int bias) {
    struct Special {
        int bias;
        Etc1Bias moves;
    };
    constexpr Special kSpecial[] = {
        {2, {{{-1, 0, 0}, {}}}},
        {5, {{{0, -1, 0}, {}}}},
        {6, {{{0, 0, -1}, {}}}},
        {7, {{{1, 0, 0}, {}}}},
        {11, {{{0, 1, 0}, {}}}},
        {15, {{{0, 0, 1}, {}}}},
        {18, {{{}, {-1, 0, 0}}}},
        {19, {{{}, {0, -1, 0}}}},
        {20, {{{}, {0, 0, -1}}}},
        {21, {{{}, {1, 0, 0}}}},
        {24, {{{}, {0, 1, 0}}}},
        {8, {{{}, {0, 0, 1}}}},
        {10, {{{-2, -2, -2}, {-2, -2, -2}}}},
        {27, {{{-1, -1, -1}, {}}}},
        {28, {{{1, 1, 1}, {-1, -1, -1}}}},
        {29, {{{}, {1, 1, 1}}}},
        {30, {{{}, {-1, -1, -1}}}},
        {31, {{{1, 1, 1}, {}}}},
    };
    for (const Special& row : kSpecial) {
        if (row.bias == bias) return row.moves;
    }
    Etc1Bias all{};
    for (int half = 0; half < 2; ++half) {
        int rest = bias;
        for (int c = 0; c < 3; ++c, rest /= 3) all.of[half][c] = static_cast<float>(rest % 3) - 1.0f;
    }
    return all;
}

class Etc1Search {
public:
    HWY_INLINE explicit Etc1Search(UastcHintGroup& group) : group_(group) {
        for (int k = 0; k < 16; ++k) {
            for (int c = 0; c < 3; ++c) {
                unit_[k][c] = hn::Load(d_, group.value[k][c]);
                code_[k][c] = hn::Load(d_, group.code[k][c]);
            }
        }
        best_ = Bc7Number(-kBc7None);
    }

    HWY_INLINE void find(Effort effort) {
        const FloatVec yes = Bc7Number(1.0f), no = hn::Zero(d_);
        for (const FloatVec flip : {no, yes}) {
            arrange(flip);
            for (const FloatVec diff : {no, yes}) {
                for (int bias = 0; bias < kEtc1Biases; ++bias) {
                    if (effort == Effort::best || bias == static_cast<int>(kEtc1Unmoved)) try_all(flip, diff, bias);
                }
            }
        }
        if (effort == Effort::normal) {
            const FloatVec flip = flip_, diff = diff_, tables[2] = {table_[0], table_[1]};
            arrange(flip);
            for (int bias = 0; bias < kEtc1Biases; ++bias) {
                if (bias != static_cast<int>(kEtc1Unmoved)) try_near(flip, diff, bias, tables);
            }
        }
        hn::Store(flip_, d_, group_.flip);
        hn::Store(diff_, d_, group_.diff);
        for (int half = 0; half < 2; ++half) hn::Store(table_[half], d_, group_.table[half]);
        hn::Store(bias_, d_, group_.bias);
    }

private:
    // The texels of both halves.
    HWY_NOINLINE void arrange(FloatVec flip) {
        const FloatMask flips = hn::Gt(flip, hn::Zero(d_));
        for (int half = 0; half < 2; ++half) {
            for (FloatVec& sum : sum_[half]) sum = hn::Zero(d_);
            for (int j = 0; j < 8; ++j) {
                const int upper = 8 * half + j, left = 2 * half + j / 4 + 4 * (j % 4);
                FloatVec code[3];
                for (int c = 0; c < 3; ++c) {
                    code[c] = hn::IfThenElse(flips, code_[upper][c], code_[left][c]);
                    sum_[half][c] = hn::Add(sum_[half][c], code[c]);
                    half_unit_[half][j][c] = hn::IfThenElse(flips, unit_[upper][c], unit_[left][c]);
                }
                light_[half][j] = hn::Add(luminance(code), luminance(code));
            }
        }
    }

    static HWY_INLINE FloatVec luminance(const FloatVec code[3]) {
        return MulThenAdd(code[0], Bc7Number(54.0f),
                          MulThenAdd(code[1], Bc7Number(183.0f), hn::Mul(code[2], Bc7Number(19.0f))));
    }

    // The base colours that a transcoder makes.
    HWY_INLINE void find_bases(FloatVec diff, int bias, FloatVec bases[2][3]) const {
        const Etc1Bias moves = etc1_bias(bias);
        const FloatVec zero = hn::Zero(d_);
        const FloatMask is_diff = hn::Gt(diff, zero);
        const FloatVec limit = hn::IfThenElse(is_diff, Bc7Number(31.0f), Bc7Number(15.0f));
        for (int c = 0; c < 3; ++c) {
            FloatVec code[2];
            for (int half = 0; half < 2; ++half) {
                const FloatVec scaled = MulThenAdd(sum_[half][c], limit, Bc7Number(1020.5f));
                const FloatVec mean = hn::Floor(hn::Mul(scaled, Bc7Number(1.0f / 2040.0f)));
                const float move = moves.of[half][c];
                FloatVec moved = hn::Add(mean, Bc7Number(move));
                moved = hn::IfThenElse(hn::Lt(moved, zero), hn::Sub(mean, Bc7Number(move)), moved);
                moved = hn::IfThenElse(hn::Eq(mean, limit), hn::Add(mean, Bc7Number(move - 1.0f)), moved);
                const FloatVec from_zero = Bc7Number(move < -1.0f ? 3.0f : move + 1.0f);
                code[half] = hn::IfThenElse(hn::Eq(mean, zero), from_zero, moved);
            }
            const FloatVec step = hn::Min(hn::Max(hn::Sub(code[1], code[0]), Bc7Number(-4.0f)), Bc7Number(3.0f));
            code[1] = hn::IfThenElse(is_diff, hn::Add(code[0], step), code[1]);
            for (int half = 0; half < 2; ++half) {
                const FloatVec wide =
                    MulThenAdd(code[half], Bc7Number(8.0f), hn::Floor(hn::Mul(code[half], Bc7Number(0.25f))));
                bases[half][c] = hn::IfThenElse(is_diff, wide, hn::Mul(code[half], Bc7Number(17.0f)));
            }
        }
    }

    // The sum of the cosines of the texels of a half.
    HWY_NOINLINE FloatVec cosines(int half, const FloatVec base[3], FloatVec small, FloatVec large) const {
        const FloatVec zero = hn::Zero(d_);
        const FloatVec modifiers[4] = {hn::Sub(zero, large), hn::Sub(zero, small), small, large};
        FloatVec palette[4][3], light[4];
        for (int m = 0; m < 4; ++m) {
            for (int c = 0; c < 3; ++c) palette[m][c] = Bc7Clamp(hn::Add(base[c], modifiers[m]), 255.0f);
            light[m] = luminance(palette[m]);
            for (int c = 0; c < 3; ++c) palette[m][c] = hn::Sub(palette[m][c], Bc7Number(kBc7Middle));
            const FloatVec inverse = hn::Div(Bc7Number(1.0f), hn::Sqrt(Bc7Dot(palette[m], palette[m])));
            for (int c = 0; c < 3; ++c) palette[m][c] = hn::Mul(palette[m][c], inverse);
        }
        FloatVec least[3], sum = zero;
        for (int m = 0; m < 3; ++m) least[m] = hn::Add(light[m], light[m + 1]);
        for (int j = 0; j < 8; ++j) {
            const FloatVec its = light_[half][j];
            FloatVec vector[3] = {palette[0][0], palette[0][1], palette[0][2]};
            for (int m = 0; m < 3; ++m) {
                const FloatMask above = hn::Ge(its, least[m]);
                for (int c = 0; c < 3; ++c) vector[c] = hn::IfThenElse(above, palette[m + 1][c], vector[c]);
            }
            sum = hn::Add(sum, Bc7Dot(vector, half_unit_[half][j]));
        }
        return sum;
    }

    HWY_INLINE void take_better(FloatVec flip, FloatVec diff, int bias, const FloatVec found[2],
                                const FloatVec tables[2]) {
        const FloatVec all = hn::Add(found[0], found[1]);
        const FloatMask better = hn::Gt(all, best_);
        best_ = hn::Max(all, best_);
        flip_ = hn::IfThenElse(better, flip, flip_);
        diff_ = hn::IfThenElse(better, diff, diff_);
        bias_ = hn::IfThenElse(better, Bc7Number(static_cast<float>(bias)), bias_);
        for (int half = 0; half < 2; ++half) table_[half] = hn::IfThenElse(better, tables[half], table_[half]);
    }

    // All tables.
    HWY_NOINLINE void try_all(FloatVec flip, FloatVec diff, int bias) {
        FloatVec bases[2][3], found[2], tables[2];
        find_bases(diff, bias, bases);
        for (int half = 0; half < 2; ++half) {
            found[half] = Bc7Number(-kBc7None);
            tables[half] = hn::Zero(d_);
            for (int t = 0; t < kEtc1Tables; ++t) {
                const FloatVec sum =
                    cosines(half, bases[half], Bc7Number(kEtc1Modifiers[t][0]), Bc7Number(kEtc1Modifiers[t][1]));
                const FloatMask better = hn::Gt(sum, found[half]);
                found[half] = hn::Max(sum, found[half]);
                tables[half] = hn::IfThenElse(better, Bc7Number(static_cast<float>(t)), tables[half]);
            }
        }
        take_better(flip, diff, bias, found, tables);
    }

    // The tables beside given ones, too.
    HWY_NOINLINE void try_near(FloatVec flip, FloatVec diff, int bias, const FloatVec given[2]) {
        FloatVec bases[2][3], found[2], tables[2];
        find_bases(diff, bias, bases);
        for (int half = 0; half < 2; ++half) {
            found[half] = Bc7Number(-kBc7None);
            tables[half] = given[half];
            for (const float step : {-1.0f, 0.0f, 1.0f}) {
                const FloatVec table = Bc7Clamp(hn::Add(given[half], Bc7Number(step)), kEtc1Tables - 1.0f);
                FloatVec modifiers[2] = {hn::Zero(d_), hn::Zero(d_)};
                for (int t = 0; t < kEtc1Tables; ++t) {
                    const FloatMask is_it = hn::Eq(table, Bc7Number(static_cast<float>(t)));
                    for (int m = 0; m < 2; ++m)
                        modifiers[m] = hn::IfThenElse(is_it, Bc7Number(kEtc1Modifiers[t][m]), modifiers[m]);
                }
                const FloatVec sum = cosines(half, bases[half], modifiers[0], modifiers[1]);
                const FloatMask better = hn::Gt(sum, found[half]);
                found[half] = hn::Max(sum, found[half]);
                tables[half] = hn::IfThenElse(better, table, tables[half]);
            }
        }
        take_better(flip, diff, bias, found, tables);
    }

    const FloatTag d_ = {};
    UastcHintGroup& group_;
    FloatVec unit_[16][3], code_[16][3];
    FloatVec half_unit_[2][8][3], light_[2][8], sum_[2][3];
    FloatVec best_, flip_, diff_, bias_, table_[2];
};

void FindEtc1Hints(Effort effort, UastcHintGroup& group) { Etc1Search(group).find(effort); }

}  // namespace HWY_NAMESPACE
}  // namespace tex::inline v1
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tex::inline v1 {

TEX_KERNEL(void, find_etc1_hints, FindEtc1Hints, (Effort effort, UastcHintGroup& group), (effort, group))

}  // namespace tex::inline v1
#endif
