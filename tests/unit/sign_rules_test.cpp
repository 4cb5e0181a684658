// SPDX-License-Identifier: Apache-2.0
// Maps whose files declare the other sign than their texels have.

#include "checks/sign_rules.h"

#include <cmath>
#include <cstdint>
#include <set>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include <tex/bake.h>
#include <tex/check.h>
#include <tex/pack.h>

namespace tex {
namespace {

MipChain waves(float bumpiness) {
    HeightField field{Plane<float>(Extent{64, 64}), bumpiness, bumpiness, Wrap::clamp, Wrap::clamp};
    for (int k = 0; k < 64 * 64; ++k) {
        const double x = k % 64, y = k / 64;
        field.height.at(k % 64, k / 64) =
            static_cast<float>(0.5 + 0.3 * std::sin(0.31 * x + 0.1 * y) * std::sin(0.23 * y));
    }
    MipChain chain;
    chain.levels.push_back(*bake(field));
    return chain;
}

Texture packed_as(const MipChain& chain, Encoding encoding) {
    return *pack(chain, {encoding, YAxis::up, Effort::fast});
}

// Signed numbers of 8 or 16 bits, which pack() does not write.
Texture in_bytes(const NormalMap& map, Format format) {
    const int bits = format_info(format).bits;
    Texture texture;
    texture.format = format;
    texture.swizzle = kSwizzleXy;
    texture.levels.push_back({map.extent(), {}});
    for (int k = 0; k < map.extent().texels(); ++k) {
        const int i = k % map.extent().width, j = k / map.extent().width;
        for (const float c : {map.x.at(i, j), map.y.at(i, j)}) {
            const auto code = static_cast<std::int16_t>(std::lround(c * static_cast<float>((1 << (bits - 1)) - 1)));
            for (int shift = 0; shift < bits; shift += 8)
                texture.levels[0].bytes.push_back(static_cast<std::byte>(code >> shift & 0xff));
        }
    }
    return texture;
}

std::set<std::string, std::less<>> rules_met(const Texture& texture) {
    const auto report = check("map", texture, {});
    std::set<std::string, std::less<>> met;
    for (const Finding& finding : report->findings) met.insert(std::string(finding.rule->id));
    return met;
}

// Equal texels, declared with the format of another texture.
Texture declared_as(Texture texture, const Texture& other) {
    texture.format = other.format;
    return texture;
}

TEST(SignRules, FindEveryFormatThatDeclaresTheWrongSign) {
    for (const float bumpiness : {0.5f, 2.0f, 12.0f}) {
        const MipChain chain = waves(bumpiness);
        const std::pair<Texture, Texture> twins[] = {
            {packed_as(chain, Encoding::bc5), packed_as(chain, Encoding::bc5_snorm)},
            {packed_as(chain, Encoding::eac_rg11), packed_as(chain, Encoding::eac_rg11_snorm)},
            {packed_as(chain, Encoding::rg8), in_bytes(chain.levels[0], Format::rg8_snorm)},
            {packed_as(chain, Encoding::rg16), in_bytes(chain.levels[0], Format::rg16_snorm)},
        };
        for (const auto& [plain, with_sign] : twins) {
            SCOPED_TRACE(testing::Message() << name_of(kFormatNames, plain.format) << " " << bumpiness);
            EXPECT_FALSE(rules_met(plain).contains("N311"));
            EXPECT_FALSE(rules_met(with_sign).contains("N311"));
            for (const auto& wrong : {declared_as(plain, with_sign), declared_as(with_sign, plain)}) {
                const auto met = rules_met(wrong);
                EXPECT_TRUE(met.contains("N311"));
                EXPECT_EQ(met.size(), 1u);
            }
        }
    }
}

// Noise is outside the unit circle with either sign.
TEST(SignRules, SayNothingOfNoise) {
    Texture noise;
    noise.format = Format::rg8_unorm;
    noise.swizzle = kSwizzleXy;
    noise.levels.push_back({{64, 64}, std::vector<std::byte>(64 * 64 * 2)});
    unsigned state = 1;
    for (std::byte& b : noise.levels[0].bytes)
        b = static_cast<std::byte>((state = state * 1664525u + 1013904223u) >> 24);
    EXPECT_TRUE(rules_met(noise).contains("N203"));
    EXPECT_FALSE(rules_met(noise).contains("N311"));
}

}  // namespace
}  // namespace tex
