// SPDX-License-Identifier: Apache-2.0
// The tables of fields: what each structure's defaults, names and ranges promise. usable_test.cpp has what validate()
// says of values that are not accepted.

#include <limits>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "fields/bake_fields.h"
#include "fields/blend_fields.h"
#include "fields/field_check.h"
#include "fields/file_fields.h"
#include "fields/height_fields.h"
#include "fields/mesh_fields.h"
#include "fields/mip_fields.h"
#include "fields/pack_fields.h"
#include "fields/preview_fields.h"
#include "fields/surface_fields.h"

namespace tex {
namespace {

// The names of a table.
struct Names {
    template <class... Rest>
    void operator()(const char* name, const Rest&...) {
        EXPECT_TRUE(all.insert(name).second) << name << " is listed twice";
    }
    std::set<std::string> all;
};

template <class O>
class Fields : public testing::Test {};
using Structures = testing::Types<BakeOptions, HeightOptions, ColorOptions, MipOptions, RdoOptions, PackOptions,
                                  UnpackOptions, Scaling, BlendOptions, Layer, IntegrateOptions, CurvatureOptions,
                                  OcclusionOptions, ConvertOptions, TransferOptions, WriteOptions, ReadOptions, Light,
                                  Material, Camera, Detail, Parallax, PreviewOptions>;
TYPED_TEST_SUITE(Fields, Structures);

TYPED_TEST(Fields, DefaultsAreAcceptedAndNamesDiffer) {
    const TypeParam options{};
    const auto checked = check_fields(options);
    EXPECT_TRUE(checked) << checked.error().reason;
    Names names;
    each_field(options, names);
    EXPECT_FALSE(names.all.empty());
}

TEST(FieldRanges, AreThoseOfTheTable) {
    const Range blur = range_of(&HeightOptions::blur_sigma);
    EXPECT_EQ(blur.least, 0.0);
    EXPECT_EQ(blur.greatest, 256.0);
    EXPECT_EQ(range_of(&PreviewOptions::tiles_y).greatest, 256.0) << "of two axes, the second";
    EXPECT_EQ(range_of(&HeightOptions::wrap_x).greatest, std::numeric_limits<double>::infinity()) << "no number";
    EXPECT_EQ(interval_of(range_of(&Scaling::scale)).least, -1e6) << "a magnitude has two sides";
    EXPECT_EQ(interval_of(range_of(&IntegrateOptions::least_response)).least, 0.0) << "or 0";
}

TEST(FieldRanges, SayWhatMustBeTrue) {
    EXPECT_EQ(requirement({0.0, 256.0}), "must be from 0 to 256");
    EXPECT_EQ(requirement({0.0, 64.0, false}), "must be above 0 and at most 64");
    EXPECT_EQ(requirement(kPositive), "must be above 0");
    EXPECT_EQ(requirement(kNotNegative), "must be 0 or more");
    EXPECT_EQ(requirement({}), "must be finite");
    EXPECT_EQ(requirement({64.0, 1048576.0}), "must be from 64 to 1048576");
    EXPECT_EQ(requirement({1e-20, 1e20, true, true}), "must be from 1e-20 to 1e20 in magnitude");
    EXPECT_EQ(requirement(range_of(&IntegrateOptions::least_response)), "must be from 1e-6 to 1, or 0");
    EXPECT_EQ(requirement(range_of(&Layer::offset_x)), "must be at most 4096 in magnitude");
    EXPECT_EQ(requirement(range_of(&MipOptions::levels)), "must be 0, for all, or more");
}

TEST(FieldRanges, AcceptNoNanAndNoInfinity) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    for (const Range& range : {Range{}, kPositive, kNotNegative, Range{1.0, 2.0, true, true}}) {
        EXPECT_FALSE(contains(range, std::numeric_limits<double>::quiet_NaN()));
        EXPECT_FALSE(contains(range, kInfinity));
        EXPECT_FALSE(contains(range, -kInfinity));
    }
    EXPECT_FALSE(contains(kPositive, 0.0));
    EXPECT_TRUE(contains({1.0, 2.0, true, true}, -1.5));
    EXPECT_TRUE(contains(range_of(&IntegrateOptions::least_response), 0.0));
    EXPECT_FALSE(contains(range_of(&IntegrateOptions::least_response), 1e-7));
}

TEST(FieldCheck, NamesFieldsOfInnerStructures) {
    PreviewOptions options;
    options.camera.emplace().pitch = 90.0f;
    const auto checked = check_fields(options);
    ASSERT_FALSE(checked);
    EXPECT_EQ(checked.error().reason, "camera.pitch: must be from -89 to 89");
}

}  // namespace
}  // namespace tex
