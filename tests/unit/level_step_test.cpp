// SPDX-License-Identifier: Apache-2.0
// The step to the next level: every row is made once, and rows of the larger level do not stay longer than needed.

#include "stream/level_step.h"

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace tex {
namespace {

struct MadeRows {
    std::vector<int> rows;  // of the smaller level, in their order
    long most_kept = 0;     // rows of the larger level at one time
};

// Puts all rows on the shelf, in the order of row_shelf.h, and makes rows as soon as that is possible.
MadeRows made_rows(LevelStep& step, int height, int start) {
    MadeRows result;
    const auto all = std::make_shared<int>(0);  // has an owner more for each row that is kept
    const std::vector<float> values(1, 0.0f);
    for (int k = 0; k < height; ++k) {
        ShelfRow row;
        row.planes[0] = values.data();
        row.owner = all;
        step.shelf.put((start + k) % height, std::move(row));
        row.owner.reset();
        result.most_kept = std::max(result.most_kept, all.use_count() - 1);
        while (step.is_ready()) {
            result.rows.push_back(step.row());
            step.advance();
        }
    }
    return result;
}

TEST(LevelStep, MakesEveryRowOnceAndKeepsFewRows) {
    for (const auto& filter : kMipFilterNames) {
        for (const auto& wrap : kWrapNames) {
            for (const int height : {200, 201, 256}) {
                for (const int start : {0, 1, 2, 5}) {
                    MipOptions options;
                    options.filter = filter.value;
                    options.wrap_x = options.wrap_y = wrap.value;
                    LevelStep step({8, height}, 0, 1, start, options);
                    const MadeRows result = made_rows(step, height, start);
                    SCOPED_TRACE(testing::Message()
                                 << filter.name << ' ' << wrap.name << ' ' << height << ' ' << start);
                    std::vector<int> sorted = result.rows;
                    std::sort(sorted.begin(), sorted.end());
                    ASSERT_EQ(sorted.size(), static_cast<std::size_t>(height / 2));
                    for (int k = 0; k < height / 2; ++k) EXPECT_EQ(sorted[static_cast<std::size_t>(k)], k);
                    const AxisFilter& y = step.filter.y;
                    EXPECT_LE(result.most_kept, 4 * y.taps + 2 * std::abs(y.first) + 2 * start + 8);
                }
            }
        }
    }
}

// Only an axis that repeats needs its last rows for its first ones.
TEST(LevelStep, RowsOfAnAxisThatEndsComeInTheirOrder) {
    for (const auto& filter : kMipFilterNames) {
        for (const Wrap wrap : {Wrap::clamp, Wrap::mirror}) {
            MipOptions options;
            options.filter = filter.value;
            options.wrap_x = options.wrap_y = wrap;
            LevelStep step({8, 200}, 0, 1, 0, options);
            const MadeRows result = made_rows(step, 200, 0);
            ASSERT_EQ(result.rows.size(), 100u) << filter.name;
            EXPECT_TRUE(std::is_sorted(result.rows.begin(), result.rows.end())) << filter.name;
        }
    }
}

}  // namespace
}  // namespace tex
