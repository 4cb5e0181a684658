// SPDX-License-Identifier: Apache-2.0

#include "rows/border.h"

#include <cmath>

#include <gtest/gtest.h>

#include "reference/bake.h"
#include "unit/fields.h"

namespace {

using tex::Extent;
using tex::Wrap;

constexpr Wrap kBorderWraps[] = {Wrap::repeat, Wrap::clamp, Wrap::mirror};

TEST(Border, HeightsBeyondItFollowTheRulesOfWrap) {
    for (const Wrap wrap : kBorderWraps) {
        for (const int n : {1, 2, 3, 8}) {
            const auto h = [](int i) { return std::sin(1.0 + i); };
            tex::reference::Grid<double> row(Extent{n, 1});
            for (int i = 0; i < n; ++i) row.at(i, 0) = h(i);
            for (int i = -40; i < 40; ++i) {
                const tex::HeightIndex at = tex::height_index(wrap, i, n);
                const double base = at.reflected ? 2.0 * h(at.edge) - h(at.index) : h(at.index);
                const double height = base + at.drift * (h(at.edge) - h(at.other));
                EXPECT_NEAR(height, tex::reference::height_at(row, wrap, wrap, i, 0), 1e-12) << n << " " << i;
            }
        }
    }
}

TEST(Border, FiltersReadTexelsInside) {
    const int repeat[] = {1, 2, 0, 1, 2, 0, 1}, clamp[] = {0, 0, 0, 1, 2, 2, 2}, mirror[] = {1, 0, 0, 1, 2, 2, 1};
    for (int i = -2; i < 5; ++i) {
        EXPECT_EQ(tex::border_index(Wrap::repeat, i, 3), repeat[i + 2]);
        EXPECT_EQ(tex::border_index(Wrap::clamp, i, 3), clamp[i + 2]);
        EXPECT_EQ(tex::border_index(Wrap::mirror, i, 3), mirror[i + 2]);
    }
}

TEST(Border, RowsOfHeightsHaveAnApronOnAllSides) {
    for (const Wrap wrap_x : kBorderWraps) {
        for (const Wrap wrap_y : kBorderWraps) {
            const auto plane = tex::fields::plane_of({5, 4}, [](int i, int j) { return tex::fields::noise(i, j); });
            const auto truth = tex::reference::grid_of(plane);
            tex::HeightRows rows(plane.view(), wrap_x, wrap_y, 9, 3);
            for (int j = -10; j < 14; ++j) {
                rows.fetch(j);
                if (j < -8) continue;
                for (int kept = j - 2; kept <= j; ++kept) {
                    for (int i = -9; i < 5 + 9; ++i) {
                        ASSERT_NEAR(static_cast<double>(rows.row(kept)[i]),
                                    tex::reference::height_at(truth, wrap_x, wrap_y, i, kept), 1e-5);
                    }
                }
            }
        }
    }
}

}  // namespace
