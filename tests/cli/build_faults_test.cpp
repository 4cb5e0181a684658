// SPDX-License-Identifier: Apache-2.0
// build-normals while calls of the system fail (tests/preload/faults.cpp).

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "cli/texture_tree.h"

namespace tex::cli {

class BuildFaults : public TextureTree {};

// A call of the system that fails, whichever it is: a full or broken disk, an input that cannot be read.
TEST_F(BuildFaults, AFailureAtAnyCallLosesNothing) {
    const Scratch counts;
    ASSERT_EQ(build().code, 0);
    const auto expected = outputs();
    const auto before = scratch_.list();
    Setting setting;
    int failed = 0, calls = 0;
    for (int n = 1; n == 1 || calls >= n - 1; n += 2) {
        SCOPED_TRACE(n);
        fs::remove(scratch_.path("out/art/wall_n.dds"));
        scratch_.write("out/shared/grain.dds", "changed");
        counts.write("calls", std::string(sizeof(int), '\0'));
        setting.environment = {"LD_PRELOAD=" TEX_BINARY_DIR "/faults.so", "TEX_FAULT_COUNT=" + counts.path("calls"),
                               fmt::format("TEX_FAULT_AT={}", n),
                               fmt::format("TEX_FAULT_ERRNO={}", n % 4 == 1 ? ENOSPC : EIO),
                               fmt::format("TEX_FAULT_NO_TMPFILE={}", n / 2 % 2)};
        const Ran ran = build({"--cache", counts.path("cache"), "--threads", "1"}, setting);
        std::memcpy(&calls, counts.read("calls").data(), sizeof calls);
        ASSERT_TRUE(ran.code == 0 || ran.code == 2 || ran.code == 3 || ran.code == 4) << ran.code << "\n" << ran.err;
        failed += ran.code != 0;
        for (const auto& [name, contents] : outputs()) {
            ASSERT_TRUE(expected.contains(name)) << name;
            EXPECT_TRUE(contents == expected.at(name) || contents == "changed") << name;
        }
    }
    EXPECT_GT(failed, 0);
    // What the cache took in between is right, and nothing else is left.
    fs::remove_all(scratch_.path("out"));
    ASSERT_EQ(build({"--cache", counts.path("cache")}).code, 0);
    EXPECT_TRUE(outputs() == expected);
    EXPECT_EQ(scratch_.list(), before);
}

}  // namespace tex::cli
