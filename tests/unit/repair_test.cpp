// SPDX-License-Identifier: Apache-2.0

#include <tex/repair.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <tex/bake.h>
#include <tex/check.h>
#include <tex/pack.h>

#include "reference/damage.h"
#include "unit/repaired_maps.h"

namespace tex::repaired_maps {

TEST(Repair, LeavesACleanMapAsItIs) {
    const Repaired done = repaired(reference::texture_of(clean()));
    EXPECT_FALSE(done.texture);
    EXPECT_TRUE(done.steps.empty());
    EXPECT_FALSE(done.has_errors());
}

TEST(Repair, TakesTheCurveBackAsDoubleArithmeticDoes) {
    const auto expected = [](const Codes& damaged, double (*by)(double)) {
        std::vector<unsigned char> codes;
        for (const unsigned char code : damaged.values)
            codes.push_back(static_cast<unsigned char>(std::floor(by(code / 255.0) * 255.0 + 0.5)));
        return codes;
    };
    const auto encode = [](double c) { return c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055; };
    const auto decode = [](double c) { return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4); };
    const Codes light = reference::srgb_encode(clean()), dark = reference::srgb_decode(clean());
    const Repaired of_light = repaired(reference::texture_of(light)), of_dark = repaired(reference::texture_of(dark));
    EXPECT_EQ(plan_of(of_light), "N302 decode with the sRGB curve");
    EXPECT_EQ(plan_of(of_dark), "N301 encode with the sRGB curve");
    ASSERT_TRUE(of_light.texture && of_dark.texture);
    EXPECT_EQ(codes_in(*of_light.texture), expected(light, decode));
    EXPECT_EQ(codes_in(*of_dark.texture), expected(dark, encode));
    EXPECT_GT(of_light.steps.front().degrees, 10.0);
}

// Gamma 2.2, as image editors have it, is not the curve of sRGB: the middle, 186, would become 125.
TEST(Repair, TakesAPlainGammaBackThatIsNearlyTheCurve) {
    Codes light = clean();
    for (unsigned char& code : light.values)
        code = static_cast<unsigned char>(std::floor(std::pow(code / 255.0, 1.0 / 2.2) * 255.0 + 0.5));
    const Texture texture = reference::texture_of(light);
    const Repaired done = repaired(texture);
    EXPECT_EQ(plan_of(done), "N302 take gamma 2.200 back");
    ASSERT_TRUE(done.texture);
    EXPECT_LT(angle(*done.texture, reference::texture_of(clean())), 0.7) << "what rounding costs";
}

// A layer of grey at half opacity: flat texels are short then, and no background that was not filled.
TEST(Repair, ShortFlatTexelsAreNoBackground) {
    Codes half = clean();
    for (unsigned char& code : half.values) code = static_cast<unsigned char>((code + 128) / 2);
    for (std::size_t k = 0; k < half.values.size() / 2; ++k) half.values[k] = k % 3 == 2 ? 191 : 128;
    const Texture texture = reference::texture_of(half);
    const Repaired done = repaired(texture);
    for (const Finding& finding : done.after.findings) EXPECT_NE(finding.rule->id, "N215");
    RepairOptions options;
    options.likely = true;
    EXPECT_EQ(plan_of(repaired(texture, options)).find("N215"), std::string::npos);
}

TEST(Repair, DividesByAlphaAndKeepsIt) {
    const Texture damaged = reference::texture_of(reference::with_alpha(clean(), true));
    const Codes straight = reference::with_alpha(clean(), false);
    const Repaired done = repaired(damaged);
    ASSERT_TRUE(done.texture) << plan_of(done);
    EXPECT_EQ(done.steps.front().kind, RepairKind::divide_by_alpha);
    const auto codes = codes_in(*done.texture), before = codes_in(damaged);
    ASSERT_EQ(codes.size(), straight.values.size());
    for (std::size_t k = 0; k < codes.size(); k += 4) {
        EXPECT_EQ(codes[k + 3], straight.values[k + 3]);
        const int alpha = codes[k + 3];
        if (alpha == 0) {
            EXPECT_EQ(codes[k + 2], 255);
        }
        for (std::size_t c = 0; c < 3 && alpha > 0; ++c) {
            const int expected = std::min(255, static_cast<int>(std::floor(before[k + c] * 255.0 / alpha + 0.5)));
            EXPECT_NEAR(codes[k + c], expected, 1);
        }
    }
}

TEST(Repair, PutsChannelsBackWhereTheyWere) {
    const Repaired done = repaired(reference::texture_of(reference::exchange(clean(), 0, 2)));
    EXPECT_EQ(plan_of(done), "N308 exchange R and B");
    ASSERT_TRUE(done.texture);
    EXPECT_EQ(codes_in(*done.texture), clean().values);
    // x and y: only if the direction of green is required.
    const Texture exchanged = reference::texture_of(reference::exchange(clean(), 0, 1));
    RepairOptions options;
    options.likely = true;
    EXPECT_EQ(plan_of(repaired(exchanged, options)), "");
    options.checks.require.y = YAxis::up;
    const Repaired back = repaired(exchanged, options);
    EXPECT_EQ(plan_of(back), "N308 exchange R and G");
    ASSERT_TRUE(back.texture);
    EXPECT_EQ(codes_in(*back.texture), clean().values);
}

TEST(Repair, RebuildsBlue) {
    const Codes steep = reference::codes_of(bumps(25.0f));
    const auto with_blue = [](auto&& change, Codes codes = clean()) {
        for (std::size_t k = 2; k < codes.values.size(); k += 3) codes.values[k] = change(codes.values[k]);
        return reference::texture_of(codes);
    };
    const Texture plain = reference::texture_of(clean());
    const Texture from_zero =
        with_blue([](unsigned char b) { return static_cast<unsigned char>(std::max(0, 2 * b - 255)); }, steep);
    const Repaired stretched = repaired(from_zero);
    EXPECT_EQ(plan_of(stretched), "N221 store z as (z + 1) / 2");
    ASSERT_TRUE(stretched.texture);
    EXPECT_LT(angle(*stretched.texture, reference::texture_of(steep)), 0.2);
    // z is off by some codes, so that something else happened, too.
    Codes noisy = steep;
    for (std::size_t k = 2; k < noisy.values.size(); k += 3) {
        const int off = static_cast<int>(k / 3 * 7 % 13) - 6;
        noisy.values[k] = static_cast<unsigned char>(std::clamp(2 * noisy.values[k] - 255 + off, 0, 255));
    }
    const Repaired more = repaired(reference::texture_of(noisy));
    const auto found = std::find_if(more.before.findings.begin(), more.before.findings.end(),
                                    [](const Finding& finding) { return finding.rule->id == "N221"; });
    ASSERT_NE(found, more.before.findings.end());
    EXPECT_LT(found->confidence, 0.95);
    EXPECT_EQ(plan_of(more).find("N221"), std::string::npos) << "it is likely, and no option asks for that";
    const Repaired rebuilt = repaired(with_blue([](unsigned char) { return static_cast<unsigned char>(255); }));
    EXPECT_EQ(plan_of(rebuilt), "N209 rebuild z from x and y");
    ASSERT_TRUE(rebuilt.texture);
    EXPECT_LT(angle(*rebuilt.texture, plain), 0.5);
    EXPECT_EQ(codes_in(*rebuilt.texture)[0], clean().values[0]);
    const Texture inverted = with_blue([](unsigned char b) { return static_cast<unsigned char>(255 - b); });
    const Repaired asked = repaired(inverted);
    EXPECT_FALSE(asked.texture);
    ASSERT_FALSE(asked.left.empty());
    EXPECT_EQ(asked.left.front().certainty, RepairClass::likely);
    EXPECT_TRUE(asked.has_errors());
    RepairOptions options;
    options.likely = true;
    const Repaired done = repaired(inverted, options);
    ASSERT_TRUE(done.texture);
    EXPECT_EQ(codes_in(*done.texture), clean().values);
}

TEST(Repair, TurnsGreenOverAndStatesIt) {
    RepairOptions options;
    options.checks.require.y = YAxis::up;
    options.likely = true;
    const Texture flipped = reference::texture_of(reference::flip_green(clean()));
    // Slopes alone do not show whether green or red is the other way round.
    const Repaired left = repaired(flipped, options);
    EXPECT_FALSE(left.texture);
    ASSERT_FALSE(left.left.empty());
    EXPECT_EQ(left.left.front().certainty, RepairClass::choice);
    options.mirrored = MirroredChannel::green;
    const Repaired done = repaired(flipped, options);
    EXPECT_EQ(plan_of(done), "N401 invert G");
    EXPECT_EQ(done.steps.front().certainty, RepairClass::safe);
    ASSERT_TRUE(done.texture);
    EXPECT_EQ(codes_in(*done.texture), clean().values);
    EXPECT_TRUE(done.texture->y_known);
    EXPECT_EQ(done.texture->y_axis, YAxis::up);
}

TEST(Repair, TurnsRedOverInAPictureThatWasMirrored) {
    Codes mirrored = clean(), red = clean();
    for (int k = 0; k < red.extent.width * red.extent.height; ++k) {
        const int i = k % red.extent.width, j = k / red.extent.width;
        red.at(i, j, 0) = static_cast<unsigned char>(255 - clean().at(i, j, 0));
        for (int c = 0; c < 3; ++c) mirrored.at(i, j, c) = clean().at(red.extent.width - 1 - i, j, c);
    }
    RepairOptions options;
    options.checks.require.y = YAxis::up;
    options.mirrored = MirroredChannel::red;
    const Repaired done = repaired(reference::texture_of(red), options);
    EXPECT_EQ(plan_of(done), "N401 invert R");
    ASSERT_TRUE(done.texture);
    EXPECT_EQ(codes_in(*done.texture), clean().values);
    EXPECT_EQ(plan_of(repaired(reference::texture_of(mirrored), options)), "N401 invert R");
}

TEST(Repair, BakesHeightsWhoseBumpinessIsGiven) {
    Codes grey = clean();
    for (int k = 0; k < grey.extent.width * grey.extent.height; ++k) {
        const int i = k % grey.extent.width, j = k / grey.extent.width;
        for (int c = 0; c < 3; ++c)
            grey.at(i, j, c) = static_cast<unsigned char>(128.0 + 90.0 * std::sin(0.1 * i) * std::cos(0.07 * j));
    }
    const Texture heights = reference::texture_of(grey);
    const Repaired left = repaired(heights);
    ASSERT_FALSE(left.left.empty());
    EXPECT_EQ(left.left.front().certainty, RepairClass::choice);
    RepairOptions options;
    options.bumpiness = 20.0f;
    const Repaired done = repaired(heights, options);
    ASSERT_TRUE(done.texture);
    EXPECT_EQ(plan_of(done), "N210 bake normals from the heights");
    HeightField field{Plane<float>(grey.extent), 20.0f, 20.0f, Wrap::repeat, Wrap::repeat};
    for (int k = 0; k < grey.extent.width * grey.extent.height; ++k)
        field.height.at(k % grey.extent.width, k / grey.extent.width) =
            static_cast<float>(grey.at(k % grey.extent.width, k / grey.extent.width, 0)) / 255.0f;
    EXPECT_EQ(codes_in(*done.texture), reference::codes_of(*bake(field)).values);
}

TEST(Repair, TurnsGreenOverInOneHalf) {
    const Codes flipped = reference::flip_green(clean());
    const auto half = [&](auto&& is_flipped) {
        Codes codes = clean();
        for (int j = 0; j < codes.extent.height; ++j) {
            for (int i = 0; i < codes.extent.width; ++i) {
                if (is_flipped(i, j)) codes.at(i, j, 1) = flipped.at(i, j, 1);
            }
        }
        return reference::texture_of(codes);
    };
    RepairOptions options;
    options.likely = true;
    options.only = {"N402"};
    for (const Texture& texture :
         {half([](int i, int) { return i < 150; }), half([](int i, int) { return i >= 201; }),
          half([](int, int j) { return j < 173; }), half([](int, int j) { return j >= 190; })}) {
        ASSERT_FALSE(repaired(texture, {}).texture);
        const Repaired done = repaired(texture, options);
        ASSERT_TRUE(done.texture) << done.before.findings.size();
        EXPECT_EQ(plan_of(done), "N402 invert green in a part of the map");
        EXPECT_EQ(codes_in(*done.texture), clean().values);
        // The direction that is required decides, and not that of more regions.
        RepairOptions wanted = options;
        wanted.checks.require.y = YAxis::down;
        const Repaired down = repaired(texture, wanted);
        ASSERT_TRUE(down.texture) << down.before.findings.size();
        EXPECT_EQ(codes_in(*down.texture), flipped.values);
    }
}

// A half that was mirrored from left to right has its red inverted, and no line across which green is.
TEST(Repair, LeavesAHalfThatWasMirrored) {
    const Codes whole = clean();
    Codes codes = whole;
    const int half = codes.extent.width / 2;
    for (int j = 0; j < codes.extent.height; ++j) {
        for (int i = 0; i < half; ++i) {
            for (int c = 0; c < 3; ++c) codes.at(i, j, c) = whole.at(half - 1 - i, j, c);
        }
    }
    RepairOptions options;
    options.likely = true;
    options.only = {"N402"};
    const Repaired done = repaired(reference::texture_of(codes), options);
    EXPECT_FALSE(done.texture);
    ASSERT_FALSE(done.left.empty());
    EXPECT_EQ(done.left.front().finding.rule->id, "N402");
}

TEST(Repair, TwoDamagesGoInTheRightOrder) {
    const Texture plain = reference::texture_of(clean());
    const Texture turned = reference::texture_of(reference::srgb_encode(reference::flip_green(clean())));
    RepairOptions options;
    options.likely = true;
    options.checks.require.y = YAxis::up;
    options.mirrored = MirroredChannel::green;
    const Repaired done = repaired(turned, options);
    ASSERT_TRUE(done.texture);
    EXPECT_EQ(plan_of(done).substr(0, plan_of(done).find(", N201")), "N302 decode with the sRGB curve, N401 invert G");
    EXPECT_LT(angle(*done.texture, plain), 0.5);
}

TEST(Repair, GuessesTheFirstOfTwoThatHideEachOther) {
    const Texture plain = reference::texture_of(clean());
    RepairOptions options;
    options.likely = true;
    const Codes light = reference::srgb_encode(clean()), bgr = reference::exchange(clean(), 0, 2);
    for (const Texture& texture : {reference::texture_of(reference::exchange(light, 0, 2)),
                                   reference::texture_of(reference::with_alpha(bgr, true))}) {
        const Repaired refused = repaired(texture);
        EXPECT_FALSE(refused.texture);
        ASSERT_FALSE(refused.left.empty());
        EXPECT_EQ(refused.left.front().finding.rule->id, "N214");
        const Repaired done = repaired(texture, options);
        ASSERT_TRUE(done.texture);
        EXPECT_FALSE(done.has_errors());
        EXPECT_GE(done.steps.size(), 2u) << plan_of(done);
        EXPECT_LT(angle(*done.texture, plain), 1.5) << plan_of(done);
    }
}

TEST(Repair, ChangesWhatTheHeaderSays) {
    MipChain chain;
    chain.levels.push_back(bumps());
    Texture plain = *pack(chain, {Encoding::bc5, YAxis::up, Effort::fast});
    Texture wrong = plain;
    wrong.format = Format::bc5_snorm;
    const Repaired done = repaired(wrong);
    ASSERT_TRUE(done.texture) << plan_of(done);
    EXPECT_EQ(done.texture->format, Format::bc5_unorm);
    EXPECT_EQ(done.texture->levels.front().bytes, plain.levels.front().bytes);
    Texture srgb = reference::texture_of(clean());
    srgb.srgb = true;
    const Repaired dropped = repaired(srgb);
    EXPECT_EQ(plan_of(dropped), "N111 declare linear values instead of sRGB");
    ASSERT_TRUE(dropped.texture);
    EXPECT_FALSE(dropped.texture->srgb);
    EXPECT_EQ(codes_in(*dropped.texture), clean().values);
}

TEST(Repair, EncodesBlocksAgain) {
    UnpackOptions as_stored;
    as_stored.keep_length = true;
    const MipChain light = *unpack(reference::texture_of(reference::srgb_encode(clean())), as_stored);
    for (const Encoding encoding : {Encoding::bc5, Encoding::dxt5nm}) {
        MipChain plain;
        plain.levels.push_back(bumps());
        const Texture damaged = *pack(light, {encoding, YAxis::up, Effort::fast});
        const Repaired done = repaired(damaged);
        ASSERT_TRUE(done.texture) << plan_of(done);
        EXPECT_EQ(done.texture->format, damaged.format);
        EXPECT_EQ(plan_of(done), "N302 decode with the sRGB curve");
        EXPECT_LT(angle(*done.texture, *pack(plain, {encoding})), 1.5);
    }
}

TEST(Repair, BuildsLevelsAgain) {
    const auto damaged = reference::texture_of(reference::chain_of(bumps(), reference::ChainFault::not_normalised));
    const auto right = reference::texture_of(reference::chain_of(bumps(), reference::ChainFault::none));
    const Repaired done = repaired(damaged);
    EXPECT_EQ(plan_of(done), "N501 build the smaller levels from the base level");
    ASSERT_TRUE(done.texture);
    ASSERT_EQ(done.texture->levels.size(), right.levels.size());
    EXPECT_EQ(done.texture->levels[0].bytes, damaged.levels[0].bytes);
    const auto a = unpack(*done.texture), b = unpack(right);
    for (std::size_t k = 1; k < 4; ++k) EXPECT_LT(compare(a->levels[k], b->levels[k])->error.mean, 1.0) << k;
}

TEST(Repair, LeavesOutRulesThatAreSkipped) {
    const Texture damaged = reference::texture_of(reference::srgb_encode(clean()));
    RepairOptions options;
    options.skip = {"srgb-encoded"};
    const Repaired skipped = repaired(damaged, options);
    EXPECT_FALSE(skipped.texture);
    EXPECT_FALSE(skipped.has_errors());
    options.skip.clear();
    options.only = {"N301"};
    EXPECT_FALSE(repaired(damaged, options).texture);
    options.only = {"N302"};
    EXPECT_TRUE(repaired(damaged, options).texture);
}

TEST(Repair, RefusesWhatItCannotDo) {
    const Texture plain = reference::texture_of(clean());
    RepairOptions options;
    options.only = {"N999"};
    EXPECT_EQ(repair("map", plain, options).error().code, ErrorCode::bad_option);
    options.only.clear();
    options.effort = static_cast<Effort>(77);
    EXPECT_EQ(validate(options).error().code, ErrorCode::bad_option);
    Texture grey = plain;
    for (std::size_t k = 0; k < grey.levels.front().bytes.size(); ++k)
        grey.levels.front().bytes[k] = grey.levels.front().bytes[k / 3 * 3];
    const Repaired left = repaired(grey);
    EXPECT_FALSE(left.texture);
    EXPECT_TRUE(left.has_errors());
    EXPECT_EQ(left.left.front().certainty, RepairClass::choice);
    int calls = 0;
    const Execution cancelled{1, [&](double) { return ++calls < 2; }};
    const auto stopped = repair("map", reference::texture_of(reference::srgb_encode(clean())), {}, cancelled);
    ASSERT_FALSE(stopped);
    EXPECT_EQ(stopped.error().code, ErrorCode::cancelled);
}

TEST(Repair, GivesTheSameBytesForEveryNumberOfThreads) {
    const Texture damaged = reference::texture_of(reference::with_alpha(clean(), true));
    const auto one = repair("map", damaged, {}, {1, {}}), three = repair("map", damaged, {}, {3, {}});
    ASSERT_TRUE(one && three && one->texture && three->texture);
    EXPECT_EQ(codes_in(*one->texture), codes_in(*three->texture));
    EXPECT_EQ(one->steps.front().degrees, three->steps.front().degrees);
}

TEST(Repair, HasARowForEveryRepair) {
    std::set<RepairKind> kinds;
    for (const RuleRepair& row : rule_repairs()) {
        ASSERT_NE(find_rule(row.rule), nullptr) << row.rule;
        EXPECT_NE(row.certainty, RepairClass::never);
        EXPECT_NE(repair_class(*find_rule(row.rule)), RepairClass::never);
        kinds.insert(row.kind);
    }
    EXPECT_EQ(kinds.size(), std::size(kRepairKindNames));
    EXPECT_EQ(repair_class(*find_rule("N222")), RepairClass::never);
}

}  // namespace tex::repaired_maps
