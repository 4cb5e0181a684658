// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>
#include <tex/tex.h>

TEST(Tex, VersionIsSet) { EXPECT_STREQ(tex::version(), "0.1.0"); }

TEST(Tex, RuntimeNamesTheInstructionSetAndTheLibraries) {
    const tex::Runtime runtime = tex::runtime();
    EXPECT_FALSE(runtime.instruction_set.empty());
    EXPECT_EQ(runtime.dependencies.size(), 4u);
    for (const auto& [name, version] : runtime.dependencies) EXPECT_TRUE(version.find('.') != std::string::npos) << name;
}
