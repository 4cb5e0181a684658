// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include "cli/usage_error.h"
#include "tasks/name_pattern.h"

namespace tex::cli {

TEST(NamePattern, FieldsComeFromTheInput) {
    const NameFields fields = name_fields("maps/old.v2.png");
    EXPECT_EQ(NamePattern("{dir}/{stem}_n{ext}").expand(fields), "maps/old.v2_n.png");
    EXPECT_EQ(NamePattern("{{{stem}}}.dds").expand(fields), "{old.v2}.dds");
    EXPECT_EQ(NamePattern("{stem}.dds").expand(name_fields("-")), "stdin.dds");
    EXPECT_EQ(NamePattern("{dir}/{stem}").expand(name_fields("a.png")), "./a");
    EXPECT_EQ(NamePattern("{stem}{ext}").expand(name_fields(".hidden")), ".hidden");
}

TEST(NamePattern, LevelsAreFilledInLater) {
    const std::string name = NamePattern("{stem}_mip{level}{ext}").expand(name_fields("a.png"));
    EXPECT_TRUE(has_level(name));
    EXPECT_EQ(with_level(name, 12), "a_mip12.png");
    EXPECT_FALSE(has_level(NamePattern("{stem}").expand(name_fields("{level}.png"))));
}

TEST(NamePattern, MistakesAreUsageErrors) {
    for (const char* text : {"{stm}.dds", "{stem.dds", "stem}.dds", "{}.dds", "{Stem}.dds"}) {
        EXPECT_THROW(NamePattern{text}, UsageError) << text;
    }
}

}  // namespace tex::cli
