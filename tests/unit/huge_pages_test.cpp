// SPDX-License-Identifier: Apache-2.0

#include "threads/huge_pages.h"

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <tex/types.h>

namespace tex {
namespace {

// Whether the process has asked for huge pages at `address` ("hg" among the flags in /proc/self/smaps).
bool huge_pages_wanted(const void* address) {
    const auto wanted = reinterpret_cast<std::uintptr_t>(address);
    std::ifstream maps("/proc/self/smaps");
    bool here = false;
    for (std::string line; std::getline(maps, line);) {
        if (const auto dash = line.find('-'); dash != std::string::npos && dash < line.find(' ')) {
            const auto begin = std::stoull(line.substr(0, dash), nullptr, 16);
            const auto end = std::stoull(line.substr(dash + 1), nullptr, 16);
            here = wanted >= begin && wanted < end;
        } else if (here && line.rfind("VmFlags:", 0) == 0) {
            return line.find(" hg") != std::string::npos;
        }
    }
    return false;
}

TEST(HugePages, AreWantedForLargePlanesOnly) {
    if (!std::filesystem::exists("/sys/kernel/mm/transparent_hugepage")) return;  // the kernel has none
    Plane<float> large(Extent{4096, 2048}), small(Extent{1024, 512});
    EXPECT_TRUE(huge_pages_wanted(large.row(1024)));
    EXPECT_FALSE(huge_pages_wanted(small.row(256)));
}

TEST(HugePages, SmallBlocksAreLeftAlone) {
    int value = 1;
    prefer_huge_pages(&value, sizeof value);  // would be an error of the system otherwise
    prefer_huge_pages(nullptr, 0);
    EXPECT_EQ(value, 1);
}

}  // namespace
}  // namespace tex
