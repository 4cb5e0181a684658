// SPDX-License-Identifier: Apache-2.0
// The bytes of deband(), which other builds check as well. The field is small, because some of those builds are slow.

#include <tex/height.h>

#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include <gtest/gtest.h>

#include "unit/fields.h"
#include "unit/targets.h"

namespace {

using tex::HeightField;
using tex::Wrap;
using tex::fields::noise;

// Hills with holes, rough on the right, in steps of 8 bits: three strips, and more texels than one thread takes.
HeightField rounded_hills() {
    return tex::fields::field_of({500, 140}, 20.0f, Wrap::mirror, [](int i, int j) {
        if (noise(i, j, 9) < 0.01) return static_cast<double>(std::numeric_limits<float>::quiet_NaN());
        const double hill = 0.5 + 0.3 * std::sin(0.02 * i + 0.01 * j) * std::cos(0.017 * j);
        return std::round(255.0 * (hill + (i > 300 ? 0.1 * noise(i, j) : 0.0))) / 255.0;
    });
}

TEST(DebandTargets, GiveTheSameBytesForEveryNumberOfThreads) {
    std::optional<HeightField> first;
    tex::on_every_target([&] {
        for (const int threads : {1, 3}) {
            tex::DebandedField field = tex::deband(rounded_hills(), tex::Deband::on, {threads, {}}).value();
            ASSERT_TRUE(field.report.applied);
            if (!first)
                first = std::move(field);
            else
                EXPECT_TRUE(tex::fields::same_bytes(first->height, field.height)) << threads << " threads";
        }
    });
}

}  // namespace
