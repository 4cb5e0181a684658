// SPDX-License-Identifier: Apache-2.0
// That what is left early has the same result as what is measured to the end.

#include <cmath>
#include <cstddef>
#include <vector>

#include <gtest/gtest.h>

#include <tex/pack.h>

#include "checks/seam.h"
#include "checks/thresholds.h"
#include "checks/wall.h"
#include "reference/damage.h"
#include "rows/border_slope.h"

namespace tex {
namespace {

// Waves that tile, that do not, and with walls along a border.
reference::Codes seam_waves(int kind, Extent extent) {
    reference::Codes codes{extent, 3, {}};
    codes.values.resize(static_cast<std::size_t>(extent.texels()) * 3);
    const double rate = 2.0 * 3.14159265358979 * (kind % 3 == 1 ? 1.37 : 3.0);
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            const bool wall = kind >= 3 && (kind == 3 ? i == 0 || i + 1 == extent.width : j + 1 == extent.height);
            const double x = (wall && kind == 3 ? 4.0 : 0.0) + 0.4 * std::cos(rate * i / extent.width);
            const double y = (wall && kind == 4 ? 4.0 : 0.0) + 0.3 * std::cos(rate * j / extent.height + 0.02 * i);
            const double length = std::sqrt(x * x + y * y + 1.0);
            const auto code = [](double c) { return static_cast<unsigned char>(std::lround(127.5 + 127.5 * c)); };
            codes.at(i, j, 0) = code(x / length);
            codes.at(i, j, 1) = code(y / length);
            codes.at(i, j, 2) = code(1.0 / length);
        }
    }
    return codes;
}

TEST(Seam, LeavingEarlyFindsWhatTheWholeMapShows) {
    int seams = 0, walls = 0;
    for (int kind = 0; kind < 5; ++kind) {
        for (const Extent extent : {Extent{64, 64}, Extent{101, 37}, Extent{16, 200}}) {
            const Texture texture = reference::texture_of(seam_waves(kind, extent));
            const auto image = decode(texture, 0);
            ASSERT_TRUE(image);
            const Stored stored{&*image, kSwizzleXyz, false, false};
            const Seam whole = measure_seam(stored), early = find_seam(stored, thresholds::kSeamRatio);
            const SeamSteps *const expected = whole.worst_standing_out(), *const found = early.worst_standing_out();
            const bool is_seam = expected != nullptr && expected->ratio() >= thresholds::kSeamRatio;
            const bool is_found = found != nullptr && found->ratio() >= thresholds::kSeamRatio;
            ASSERT_EQ(is_found, is_seam) << kind;
            if (is_seam) {
                EXPECT_EQ(found->ratio(), expected->ratio());
            }
            seams += is_seam ? 1 : 0;

            BorderSlope border(extent);
            std::vector<float> row(3 * static_cast<std::size_t>(extent.width));
            float *const x = row.data(), *const y = x + extent.width, *const z = y + extent.width;
            for (int j = 0; j < extent.height; ++j) {
                for (int i = 0; i < extent.width; ++i) {
                    x[i] = stored.component(0, i, j);
                    y[i] = stored.component(1, i, j);
                    z[i] = stored.component(2, i, j);
                }
                border.add(j, {x, y, z});
            }
            const double ratio = border.ratio();
            EXPECT_EQ(find_wall(stored), ratio > BorderSlope::kWall ? ratio : 0.0) << kind;
            walls += ratio > BorderSlope::kWall ? 1 : 0;
        }
    }
    EXPECT_GE(seams, 1);
    EXPECT_GE(walls, 2);
}

}  // namespace
}  // namespace tex
