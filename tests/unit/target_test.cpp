// SPDX-License-Identifier: Apache-2.0

#include "kernels/target.h"

#include <set>
#include <string>

#include <gtest/gtest.h>

#include "unit/targets.h"

namespace {

TEST(Target, KernelsRunOnEachInstructionSetThatTheTestsAskFor) {
    std::set<std::string> names;
    tex::on_every_target([&] { names.insert(tex::kernel_target_name()); });
    EXPECT_EQ(names.size(), hwy::SupportedAndGeneratedTargets().size());
    EXPECT_FALSE(names.empty());
    EXPECT_EQ(names.count("unknown"), 0u);
}

TEST(Target, OfThisProcessorIsTheBestThereIs) {
    // Highway gives better targets lower numbers.
    EXPECT_EQ(tex::kernel_target(), hwy::SupportedAndGeneratedTargets().front());
}

}  // namespace
