// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>
#include <tex/tex.h>

TEST(Tex, VersionIsSet) { EXPECT_STREQ(tex::version(), "0.1.0"); }
