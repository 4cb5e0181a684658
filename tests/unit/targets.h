// SPDX-License-Identifier: Apache-2.0
// targets.h: runs a test on every instruction set that this processor has.

#pragma once

#include <cstdint>

#include <gtest/gtest.h>
#include <hwy/highway.h>

#include "kernels/target.h"

namespace tex {

// Calls test() once for each Highway target, after checking that kernels are dispatched to that target.
template <class Test>
void on_every_target(Test&& test) {
    for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
        const ::testing::ScopedTrace trace(__FILE__, __LINE__, hwy::TargetName(target));
        hwy::SetSupportedTargetsForTest(target);
        EXPECT_EQ(kernel_target(), target);
        test();
        hwy::SetSupportedTargetsForTest(0);
    }
}

}  // namespace tex
