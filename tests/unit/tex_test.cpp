// SPDX-License-Identifier: Apache-2.0

#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <tex/tex.h>

TEST(Tex, VersionIsSet) { EXPECT_STREQ(tex::version(), "1.0.0"); }

TEST(Tex, RuntimeNamesTheInstructionSetAndTheLibraries) {
    const tex::Runtime runtime = tex::runtime();
    EXPECT_FALSE(runtime.instruction_set.empty());
    std::vector<std::string> names;
    for (const auto& [name, version] : runtime.dependencies) {
        names.push_back(name);
        EXPECT_TRUE(version.find('.') != std::string::npos) << name;
    }
    EXPECT_EQ(names, (std::vector<std::string>{"highway", "libdeflate", "libisal", "libpng", "libzstd", "opencolorio",
                                               "openexr"}));
}
