// SPDX-License-Identifier: Apache-2.0
// CheckOptions::marks: which texels spoke for a finding, and which its rule left out, against masks made here.

#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <tex/check.h>

#include "reference/damage.h"

namespace tex {
namespace {

constexpr Extent kMarkedExtent{96, 64};
using At = std::function<bool(int, int)>;

// Gentle bumps, y up.
reference::Codes bumps() {
    NormalMap map(kMarkedExtent);
    for (int j = 0; j < kMarkedExtent.height; ++j) {
        for (int i = 0; i < kMarkedExtent.width; ++i) {
            const double x = 0.4 * std::sin(0.37 * i + 0.11 * j), y = 0.4 * std::cos(0.29 * j - 0.07 * i);
            map.x.at(i, j) = static_cast<float>(x);
            map.y.at(i, j) = static_cast<float>(y);
            map.z.at(i, j) = static_cast<float>(std::sqrt(1.0 - x * x - y * y));
        }
    }
    return reference::codes_of(map);
}

reference::Codes colored(reference::Codes codes, const At& where, const std::vector<int>& color) {
    for (int j = 0; j < codes.extent.height; ++j) {
        for (int i = 0; i < codes.extent.width; ++i) {
            if (!where(i, j)) continue;
            for (std::size_t c = 0; c < color.size(); ++c)
                codes.at(i, j, static_cast<int>(c)) = static_cast<unsigned char>(color[c]);
        }
    }
    return codes;
}

reference::Codes with_alpha_of(const reference::Codes& codes, const At& is_clear) {
    reference::Codes made{codes.extent, 4, {}};
    made.values.resize(static_cast<std::size_t>(codes.extent.texels()) * 4);
    for (int j = 0; j < codes.extent.height; ++j) {
        for (int i = 0; i < codes.extent.width; ++i) {
            for (int c = 0; c < 3; ++c) made.at(i, j, c) = codes.at(i, j, c);
            made.at(i, j, 3) = is_clear(i, j) ? 0 : 255;
        }
    }
    return made;
}

std::optional<Marks> marks_of(const reference::Codes& codes, const std::string& id, CheckOptions options = {}) {
    if (options.marks == 0) options.marks = 512;
    const auto report = check("map", reference::texture_of(codes), options);
    EXPECT_TRUE(report);
    for (const Finding& finding : report->findings) {
        if (finding.rule->id == id) return finding.marks;
    }
    ADD_FAILURE() << "there is no " << id;
    return std::nullopt;
}

// Squares of one texel have the mark where `where` holds, and nowhere else.
void expect_marked(const Marks& marks, Mark mark, const At& where) {
    ASSERT_EQ(marks.side, 1);
    ASSERT_EQ(marks.extent, kMarkedExtent);
    std::int64_t count = 0;
    for (int j = 0; j < kMarkedExtent.height; ++j) {
        for (int i = 0; i < kMarkedExtent.width; ++i) {
            const Mark found = marks.squares[static_cast<std::size_t>(j * kMarkedExtent.width + i)];
            ASSERT_EQ(found == mark, where(i, j)) << "column " << i << ", row " << j;
            count += where(i, j) ? 1 : 0;
        }
    }
    EXPECT_EQ(marks.count(mark), count);
}

bool in_corner(int i, int j) { return i < 30 && j < 25; }

TEST(Marks, AreNotMadeUnlessAsked) {
    const auto report = check("map", reference::texture_of(colored(bumps(), in_corner, {128, 128, 20})));
    ASSERT_TRUE(report);
    ASSERT_FALSE(report->findings.empty());
    for (const Finding& finding : report->findings) EXPECT_FALSE(finding.marks);
}

TEST(Marks, OfVectorsThatPointIntoTheSurface) {
    const At behind = [](int i, int j) { return i >= 40 && i < 44 && j >= 10 && j < 15; };
    const auto marks = marks_of(colored(bumps(), behind, {190, 128, 20}), "N202");
    ASSERT_TRUE(marks);
    expect_marked(*marks, Mark::spoke, behind);
}

TEST(Marks, LeaveOutWhatIsUnderAlphaZero) {
    const At behind = [](int i, int j) { return i >= 20 && i < 44 && j >= 10 && j < 15; };
    const auto marks = marks_of(with_alpha_of(colored(bumps(), behind, {190, 128, 20}), in_corner), "N202");
    ASSERT_TRUE(marks);
    expect_marked(*marks, Mark::spoke, [&](int i, int j) { return behind(i, j) && !in_corner(i, j); });
    expect_marked(*marks, Mark::transparent, in_corner);
}

TEST(Marks, OfObjectSpace) {
    reference::Codes codes = bumps();
    const At behind = [](int i, int j) { return (i / 8 + j / 8) % 3 == 0; };
    for (int j = 0; j < kMarkedExtent.height; ++j) {
        for (int i = 0; i < kMarkedExtent.width; ++i) {
            if (!behind(i, j)) continue;
            for (int c = 0; c < 3; ++c) codes.at(i, j, c) = static_cast<unsigned char>(255 - codes.at(i, j, c));
        }
    }
    const auto marks = marks_of(codes, "N213");
    ASSERT_TRUE(marks);
    expect_marked(*marks, Mark::spoke, behind);
}

TEST(Marks, OfBackgroundAndOfWhatItIsMixedWith) {
    const At edge = [](int i, int j) { return (i == 30 && j < 25) || (j == 25 && i < 31); };
    reference::Codes codes = colored(bumps(), in_corner, {0, 0, 0});
    codes = colored(codes, edge, {64, 64, 128});
    const auto marks = marks_of(codes, "N215");
    ASSERT_TRUE(marks);
    expect_marked(*marks, Mark::spoke, in_corner);
    expect_marked(*marks, Mark::background, edge);
}

TEST(Marks, OfTheBorderThatDoesNotMeet) {
    CheckOptions options;
    options.require.tiles = true;
    options.marks = 512;
    const auto report = check("map", reference::texture_of(bumps()), options);
    ASSERT_TRUE(report);
    for (const Finding& finding : report->findings) {
        if (finding.rule->id != "N307" || finding.regions.empty()) continue;
        const Region region = finding.regions.front();
        ASSERT_TRUE(finding.marks);
        return expect_marked(*finding.marks, Mark::spoke, [&](int i, int j) {
            return i >= region.x && i < region.x + region.width && j >= region.y && j < region.y + region.height;
        });
    }
    FAIL() << "no seam";
}

TEST(Marks, AreMissingWhereStatisticsOfTheMapSpeak) {
    const auto marks = marks_of(reference::srgb_encode(bumps()), "N302");
    EXPECT_FALSE(marks);
}

TEST(Marks, FillAtMostSoManySquares) {
    const At behind = [](int i, int j) { return i == 95 && j == 63; };
    reference::Codes codes = colored(bumps(), [](int i, int j) { return j < 2 && i < 8; }, {190, 128, 20});
    codes = colored(codes, behind, {190, 128, 20});
    CheckOptions options;
    options.marks = 10;
    const auto marks = marks_of(codes, "N202", options);
    ASSERT_TRUE(marks);
    EXPECT_EQ(marks->side, 10);
    EXPECT_EQ(marks->extent, (Extent{10, 7}));
    EXPECT_EQ(marks->squares.front(), Mark::spoke);
    EXPECT_EQ(marks->squares.back(), Mark::spoke) << "one texel is enough";
    EXPECT_EQ(marks->squares[35], Mark::none);
    EXPECT_EQ(marks->count(Mark::spoke), 17);
    options.marks = -1;
    EXPECT_FALSE(check("map", reference::texture_of(codes), options));
    options.marks = kMostMarks + 1;
    EXPECT_FALSE(check("map", reference::texture_of(codes), options));
}

}  // namespace
}  // namespace tex
