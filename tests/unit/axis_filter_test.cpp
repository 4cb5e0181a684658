// SPDX-License-Identifier: Apache-2.0

#include "rows/axis_filter.h"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "kernels/mip.h"
#include "reference/mip.h"
#include "unit/fields.h"
#include "unit/targets.h"

namespace {

using tex::Extent;
using tex::MipFilter;
using tex::fields::noise;
using tex::fields::same_bytes;

// The result of filtering `row`, with separate weights for each texel or with those of texel 0 for all.
tex::Plane<float> filtered(const float* row, int count, const tex::AxisFilter& axis, bool evenly) {
    tex::Plane<float> out(Extent{count, 1}), halves(Extent{count + axis.taps + 16, 2});
    tex::split_row(row + axis.first, count + axis.taps / 2, halves.row(0), halves.row(1));
    if (evenly) {
        std::vector<float> weights;
        for (int k = 0; k < axis.taps; ++k) weights.push_back(axis.weight(k, 0));
        tex::filter_columns_evenly(halves.row(0), halves.row(1), weights.data(), axis.taps, count, out.row(0));
    } else {
        tex::filter_columns(halves.row(0), halves.row(1), axis.weights.data(), axis.stride, axis.taps, count,
                            out.row(0));
    }
    return out;
}

TEST(AxisFilter, ThePathForHalvingGivesTheBytesOfTheGeneralPath) {
    tex::on_every_target([] {
        for (const int width : {2, 14, 16, 30, 32, 34, 66, 258}) {
            const auto rows = tex::fields::plane_of({width, 2}, [](int i, int j) { return noise(i, j) - 0.5; });
            const float* both[] = {rows.row(0), rows.row(1)};
            const float halves[] = {0.5f, 0.5f};
            tex::Plane<float> fast(Extent{width / 2, 1}), column(Extent{width + 64, 1}, 0.0f);
            tex::halve_rows(rows.row(0), rows.row(1), width / 2, fast.row(0));
            tex::filter_rows(both, halves, 2, width, column.row(0));
            const tex::AxisFilter axis = tex::make_axis_filter(MipFilter::box, width);
            EXPECT_TRUE(same_bytes(fast, filtered(column.row(0), width / 2, axis, false))) << width;
            EXPECT_TRUE(same_bytes(fast, filtered(column.row(0), width / 2, axis, true))) << width;
        }
    });
}

TEST(AxisFilter, ThePathForEvenSizesGivesTheBytesOfTheGeneralPath) {
    tex::on_every_target([] {
        for (const auto& filter : tex::kMipFilterNames) {
            const tex::AxisFilter axis = tex::make_axis_filter(filter.value, 66);
            const auto row = tex::fields::plane_of({16 + 66 + 64, 1}, [](int i, int) { return noise(i, 3) - 0.5; });
            EXPECT_TRUE(
                same_bytes(filtered(row.row(0) + 16, 33, axis, false), filtered(row.row(0) + 16, 33, axis, true)))
                << filter.name;
        }
    });
}

TEST(AxisFilter, WeightsAreThoseOfTheReference) {
    for (const auto& filter : tex::kMipFilterNames) {
        for (const int n : {1, 2, 3, 4, 5, 7, 16, 33, 257, 1000, 4095}) {
            const tex::AxisFilter axis = tex::make_axis_filter(filter.value, n);
            for (int i = 0; i < std::max(1, n / 2); ++i) {
                const tex::reference::Weights truth = tex::reference::mip_weights(filter.value, n, i);
                const int size = static_cast<int>(truth.weights.size());
                double sum = 0.0;
                for (int k = 0; k < axis.taps; ++k) {
                    const int texel = 2 * i + axis.first + k - truth.first;
                    const double expected =
                        texel >= 0 && texel < size ? truth.weights[static_cast<std::size_t>(texel)] : 0.0;
                    ASSERT_NEAR(static_cast<double>(axis.weight(k, i)), expected, 3e-8)
                        << filter.name << " " << n << " " << i;
                    sum += static_cast<double>(axis.weight(k, i));
                }
                ASSERT_NEAR(sum, 1.0, 1e-6);
            }
        }
    }
}

}  // namespace
