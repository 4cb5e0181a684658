// SPDX-License-Identifier: Apache-2.0
// DXT5nm as processors decode it, with 8 bits and weights of whole numbers (bench/decode_rules.h), against the exact
// decode, which the encoders minimise.

#include <tex/pack.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <tex/bake.h>
#include <tex/file.h>
#include <tex/height.h>

#include "bench/decode_rules.h"
#include "unit/packing.h"

namespace {

using rules::Rule;
using tex::Effort;

constexpr Rule kRules[] = {Rule::amd, Rule::intel, Rule::nvidia, Rule::truncating};

// All palettes, in 8-bit codes: how far a rule is from the exact rational value.
TEST(GpuDecode, IsWithinTheCodesOfTheManual) {
    const double most_alpha[] = {2.15, 0.86, 0.43, 0.86};
    const double most_green[] = {1.67, 0.67, 5.34, 0.67};
    for (const Rule rule : kRules) {
        double alpha = 0, green = 0;
        for (int a = 0; a < 256; ++a) {
            for (int b = 0; b < 256; ++b) {
                for (const int n : {5, 7}) {
                    for (int k = 1; k < n; ++k)
                        alpha =
                            std::max(alpha, std::abs(rules::mix(rule, a, b, k, n) - ((n - k) * a + k * b) / (1.0 * n)));
                }
                if (a > 63 || b > 63) continue;
                const int low = tex::widen_green(a);
                const int high = tex::widen_green(b);
                for (int k = 1; k < 3; ++k)
                    green =
                        std::max(green, std::abs(rules::mix(rule, low, high, k, 3) - ((3 - k) * low + k * high) / 3.0));
            }
        }
        const auto r = static_cast<std::size_t>(rule);
        EXPECT_LE(alpha, most_alpha[r]) << rules::kNames[r];
        EXPECT_GE(alpha, most_alpha[r] - 0.01) << rules::kNames[r];
        EXPECT_LE(green, most_green[r]) << rules::kNames[r];
        EXPECT_GE(green, most_green[r] - 0.01) << rules::kNames[r];
    }
}

struct Vector {
    double x, y, z;
};
Vector of_codes(double x, double y) {
    const double nx = x / 127.5 - 1;
    const double ny = y / 127.5 - 1;
    const double length = std::max(1.0, std::hypot(nx, ny));
    return {nx / length, ny / length, std::sqrt(std::max(0.0, 1 - nx * nx - ny * ny))};
}
double degrees(Vector a, Vector b) {
    const double cross = std::hypot(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
    return std::atan2(cross, a.x * b.x + a.y * b.y + a.z * b.z) * 180 / 3.14159265358979;
}

// The angle between what a rule returns and the exact decode of the same blocks.
struct Moved {
    double mean = 0, most = 0;
};
Moved moved_by(Rule rule, const std::vector<std::byte>& blocks) {
    Moved moved;
    for (std::size_t at = 0; at < blocks.size(); at += 16) {
        const std::byte* block = blocks.data() + at;
        float x[16], y[16];
        packing::decode_codes(block, tex::Encoding::dxt5nm, x, y);
        const auto colors = static_cast<int>(rules::bytes(block + 8, 4));
        const rules::Palette alphas =
            rules::alpha_palette(rule, std::to_integer<int>(block[0]), std::to_integer<int>(block[1]));
        const rules::Palette greens = rules::green_palette(rule, colors >> 5 & 63, colors >> 21 & 63);
        for (int k = 0; k < 16; ++k) {
            const int rule_x = alphas.values[rules::bytes(block + 2, 6) >> (3 * k) & 7];
            const int rule_y = greens.values[rules::bytes(block + 12, 4) >> (2 * k) & 3];
            const double angle =
                degrees(of_codes(rule_x, rule_y), of_codes(static_cast<double>(x[k]), static_cast<double>(y[k])));
            moved.mean += angle / static_cast<double>(blocks.size());
            moved.most = std::max(moved.most, angle);
        }
    }
    return moved;
}

// Rounding to 8 bits alone moves them by up to 0.33 degrees where z is near 1.
TEST(GpuDecode, MovesTheNormalsOfTheSamplesByLittle) {
    const double most[] = {0.9, 0.35, 1.5, 0.6};  // degrees
    for (const Effort effort : {Effort::fast, Effort::normal, Effort::best}) {
        for (const char* name : {"bricks", "hemisphere", "ramp", "strip", "waves"}) {
            const auto image = tex::read_image(std::string(TEX_SOURCE_DIR "/samples/") + name + ".png");
            ASSERT_TRUE(image);
            const auto field = tex::height_field(*image, {});
            ASSERT_TRUE(field);
            auto map = tex::bake(*field, {});
            ASSERT_TRUE(map);
            const auto bytes = packing::pack_bytes(packing::chain_of(std::move(*map)),
                                                   {tex::Encoding::dxt5nm, tex::YAxis::up, effort});
            for (const Rule rule : kRules) {
                const Moved moved = moved_by(rule, bytes);
                SCOPED_TRACE(std::string(name) + " " + rules::kNames[static_cast<std::size_t>(rule)]);
                EXPECT_LE(moved.mean, 0.3);
                EXPECT_LE(moved.most, most[static_cast<std::size_t>(rule)]);
            }
        }
    }
}

}  // namespace
