// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <new>
#include <utility>

#include <tex/image.h>

namespace tex {
namespace {

TEST(Plane, RowsStartAtMultiplesOfTheAlignmentAndTheirPaddingIsZero) {
    for (const int width : {1, 15, 16, 17, 33}) {
        const Plane<float> plane({width, 3}, 1.0f);
        for (int j = 0; j < 3; ++j) {
            EXPECT_EQ(reinterpret_cast<std::uintptr_t>(plane.row(j)) % kRowAlignment, 0U) << width;
            for (std::ptrdiff_t i = 0; i < plane.stride(); ++i) EXPECT_EQ(plane.row(j)[i], i < width ? 1.0f : 0.0f);
        }
    }
}

TEST(Plane, CloneIsEqualAndOwnsItsRows) {
    Plane<float> plane({17, 2}, 0.5f);
    const Plane<float> copy = plane.clone();
    plane.at(16, 1) = 2;
    EXPECT_EQ(copy.at(16, 1), 0.5f);
    EXPECT_TRUE(Plane<float>().clone().empty());
}

TEST(Plane, MovesItsRows) {
    Plane<float> plane({5, 5}, 0.25f);
    const float* const rows = plane.row(0);
    const Plane<float> moved = std::move(plane);
    EXPECT_EQ(moved.row(0), rows);
}

#ifndef __SANITIZE_ADDRESS__  // it ends a program that requests so much memory
TEST(Rows, ThrowBadAllocIfMemoryRunsOut) {
    EXPECT_THROW(free_rows(allocate_rows(std::size_t{1} << 52)), std::bad_alloc);
}
#endif

TEST(Rows, NoBytesCanBeAllocatedAndFreed) {
    void* const rows = allocate_rows(0);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(rows) % kRowAlignment, 0U);
    free_rows(rows);
}

}  // namespace
}  // namespace tex
