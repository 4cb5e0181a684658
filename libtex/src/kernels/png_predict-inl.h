// SPDX-License-Identifier: Apache-2.0
// png_predict-inl.h: what the filters of PNG predict from a byte's neighbours (W3C PNG specification, section 9), for
// kernels. Include it after hwy/highway.h, once for each target.

#if defined(TEX_KERNELS_PNG_PREDICT_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TEX_KERNELS_PNG_PREDICT_INL_H
#undef TEX_KERNELS_PNG_PREDICT_INL_H
#else
#define TEX_KERNELS_PNG_PREDICT_INL_H
#endif

#include <cstddef>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace tex::inline v1 {
namespace HWY_NAMESPACE {

// The neighbours of a byte: to the left, above, and above that to the left.
template <class D>
struct PngNeighbours {
    hwy::HWY_NAMESPACE::Vec<D> left, above, corner;
};

template <class V>
HWY_INLINE V PngDistance(V a, V b) {
    namespace hn = hwy::HWY_NAMESPACE;
    return hn::Or(hn::SaturatedSub(a, b), hn::SaturatedSub(b, a));
}

template <class D>
HWY_INLINE hwy::HWY_NAMESPACE::Vec<D> PngAverage(D d, const PngNeighbours<D>& n) {
    namespace hn = hwy::HWY_NAMESPACE;
    const auto rounded_down = hn::And(hn::Xor(n.left, n.above), hn::Set(d, hn::TFromD<D>{1}));
    return hn::Sub(hn::AverageRound(n.left, n.above), rounded_down);
}

// The neighbour that is nearest to left + above - corner. Its distance from the corner is the sum of the other two
// distances if left and above lie on the same side of the corner (the sum may saturate: it is never the smallest
// alone), and their difference otherwise.
template <class D>
HWY_INLINE hwy::HWY_NAMESPACE::Vec<D> PngPaeth(D, const PngNeighbours<D>& n) {
    namespace hn = hwy::HWY_NAMESPACE;
    const auto to_left = PngDistance(n.above, n.corner);
    const auto to_above = PngDistance(n.left, n.corner);
    const auto apart = hn::Xor(hn::Gt(n.above, n.corner), hn::Gt(n.left, n.corner));
    const auto to_corner = hn::IfThenElse(apart, PngDistance(to_left, to_above), hn::SaturatedAdd(to_left, to_above));
    const auto nearer = hn::Min(to_above, to_corner);
    const auto other = hn::IfThenElse(hn::Eq(nearer, to_above), n.above, n.corner);
    return hn::IfThenElse(hn::Eq(hn::Min(to_left, nearer), to_left), n.left, other);
}

// One byte after the other, for the bytes that do not fill a vector.
HWY_INLINE int PngPredictOne(std::size_t filter, int left, int above, int corner) {
    const auto magnitude = [](int v) { return v < 0 ? -v : v; };
    switch (filter) {
        case 1: return left;
        case 2: return above;
        case 3: return (left + above) / 2;
        case 4: {
            const int to_left = magnitude(above - corner);
            const int to_above = magnitude(left - corner);
            const int to_corner = magnitude(left + above - 2 * corner);
            if (to_left <= to_above && to_left <= to_corner) return left;
            return to_above <= to_corner ? above : corner;
        }
        default: return 0;
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace tex::inline v1
HWY_AFTER_NAMESPACE();

#endif  // once for each target
