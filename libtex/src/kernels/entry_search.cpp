// SPDX-License-Identifier: Apache-2.0

#include "kernels/entry_search.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/entry_search.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "kernels/dispatch.h"
#include "kernels/vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tex::inline v1 {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

HWY_INLINE FloatVec SquareOf(const FloatVec a[4], const FloatVec b[4]) {
    FloatVec sum[4];
    for (int c = 0; c < 4; ++c) {
        const FloatVec off = hn::Sub(a[c], b[c]);
        sum[c] = hn::Mul(off, off);
    }
    return hn::Add(hn::Add(sum[0], sum[1]), hn::Add(sum[2], sum[3]));
}

void ClosestEntries(const EntrySearch& search, float squares[16], float numbers[16]) {
    const FloatTag d;
    for (int k = 0; k < 16; k += static_cast<int>(hn::Lanes(d))) {
        FloatVec texel[4], least = hn::Set(d, 2.0f * kNoEntry), number = hn::Zero(d);
        for (int c = 0; c < 4; ++c) texel[c] = hn::LoadU(d, search.texels[c] + k);
        for (int e = 0; e < search.count; ++e) {
            FloatVec entry[4];
            for (int c = 0; c < 4; ++c) entry[c] = hn::Set(d, search.entries[c][e]);
            const FloatVec square = hn::Add(SquareOf(texel, entry), hn::LoadU(d, search.distances[search.row[e]] + k));
            const FloatMask is_less = hn::Lt(square, least);
            least = hn::Min(square, least);
            number = hn::IfThenElse(is_less, hn::Set(d, static_cast<float>(e)), number);
        }
        hn::StoreU(least, d, squares + k);
        hn::StoreU(number, d, numbers + k);
    }
}

void SquaredDistances(const float (*texels)[16], const float (*others)[16], float squares[16]) {
    const FloatTag d;
    for (int k = 0; k < 16; k += static_cast<int>(hn::Lanes(d))) {
        FloatVec a[4], b[4];
        for (int c = 0; c < 4; ++c) {
            a[c] = hn::LoadU(d, texels[c] + k);
            b[c] = hn::LoadU(d, others[c] + k);
        }
        hn::StoreU(SquareOf(a, b), d, squares + k);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace tex::inline v1
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tex::inline v1 {

TEX_KERNEL(void, closest_entries, ClosestEntries, (const EntrySearch& search, float squares[16], float numbers[16]),
           (search, squares, numbers))

TEX_KERNEL(void, squared_distances, SquaredDistances,
           (const float (*texels)[16], const float (*others)[16], float squares[16]), (texels, others, squares))

}  // namespace tex::inline v1
#endif
