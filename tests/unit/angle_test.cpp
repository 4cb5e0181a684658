// SPDX-License-Identifier: Apache-2.0

#include "kernels/angle.h"

#include <cmath>
#include <cstring>
#include <vector>

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <tex/types.h>

namespace tex {
namespace {

TEST(Angle, EveryTargetGivesTheSameBytes) {
    for (const int width : {1, 2, 15, 16, 17, 33, 257}) {
        Plane<float> values[6];
        for (int k = 0; k < 6; ++k) {
            values[k] = Plane<float>(Extent{width, 1});
            for (int i = 0; i < width; ++i) {
                values[k].at(i, 0) = static_cast<float>(std::sin(1.7 * i + 0.9 * k * k + 0.3 * i * k));
            }
        }
        const VectorRow a{values[0].row(0), values[1].row(0), values[2].row(0)};
        const VectorRow b{values[3].row(0), values[4].row(0), values[5].row(0)};
        std::vector<std::vector<float>> results;
        for (const auto target : hwy::SupportedAndGeneratedTargets()) {
            hwy::SetSupportedTargetsForTest(target);
            hwy::GetChosenTarget().Update(hwy::SupportedTargets());
            Plane<float> degrees(Extent{width, 1});
            angle_row(a, b, width, degrees.row(0));
            results.emplace_back(degrees.row(0), degrees.row(0) + width);
        }
        hwy::SetSupportedTargetsForTest(0);
        hwy::GetChosenTarget().DeInit();
        ASSERT_FALSE(results.empty());
        for (const auto& result : results) {
            ASSERT_EQ(std::memcmp(result.data(), results.front().data(), result.size() * sizeof(float)), 0);
        }
    }
}

}  // namespace
}  // namespace tex
