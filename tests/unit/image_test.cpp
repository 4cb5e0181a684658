// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <utility>

#include <tex/types.h>

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
    EXPECT_THROW(static_cast<void>(allocate_rows(std::size_t{1} << 52)), std::bad_alloc);
}
#endif

TEST(Rows, NoBytesCanBeAllocatedAndFreed) {
    const std::shared_ptr<void> rows = allocate_rows(0);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(rows.get()) % kRowAlignment, 0U);
}

TEST(Plane, SharesMemoryThatLivesAsLongAsItself) {
    Plane<float> shared;
    std::weak_ptr<float> watched;
    {
        const std::shared_ptr<float> memory(new float[6 * 32](), std::default_delete<float[]>());
        memory.get()[32 + 4] = 0.5f;
        shared = Plane<float>({5, 6}, 32, memory);
        watched = memory;
    }
    EXPECT_FALSE(watched.expired());
    EXPECT_EQ(shared.at(4, 1), 0.5f);
    const Plane<float> copy = shared.clone();
    EXPECT_EQ(copy.stride(), 16);
    EXPECT_EQ(copy.at(4, 1), 0.5f);
    EXPECT_EQ(copy.row(0)[5], 0.0f) << "padding";
    shared = {};
    EXPECT_TRUE(watched.expired());
}

TEST(NormalMap, TakesItsPlanesFromOnePieceOfMemory) {
    NormalMap map({21, 7});
    EXPECT_EQ(map.y.row(0) - map.x.row(0), map.z.row(0) - map.y.row(0));
    EXPECT_GE(map.y.row(0) - map.x.row(0), 7 * map.x.stride());
    for (const Plane<float>* plane : {&map.x, &map.y, &map.z}) {
        EXPECT_EQ(plane->extent(), (Extent{21, 7}));
        EXPECT_EQ(plane->stride(), 32);
        EXPECT_EQ(reinterpret_cast<std::uintptr_t>(plane->row(0)) % kRowAlignment, 0U);
        EXPECT_EQ(plane->row(6)[31], 0.0f) << "padding";
    }
    map.z.at(20, 6) = 0.25f;
    const Plane<float> z = std::move(map.z);
    map = {};
    EXPECT_EQ(z.at(20, 6), 0.25f);
}

}  // namespace
}  // namespace tex
