// SPDX-License-Identifier: Apache-2.0

#include "threads/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <mutex>
#include <new>
#include <set>
#include <thread>
#include <utility>
#include <vector>

namespace tex {
namespace {

using Pieces = std::set<std::pair<int, int>>;

Pieces pieces_of(int count, int grain, int threads) {
    Pieces pieces;
    std::mutex mutex;
    const Execution execution{threads, {}};
    const Result<void> done = parallel_for(execution, count, grain, [&](int begin, int end) {
        const std::lock_guard lock(mutex);
        EXPECT_TRUE(pieces.emplace(begin, end).second) << "twice: " << begin;
    });
    EXPECT_TRUE(done.has_value());
    return pieces;
}

TEST(Parallel, CutsTheSamePiecesForEveryNumberOfThreads) {
    const Pieces expected = {{0, 16}, {16, 32}, {32, 33}};
    for (const int threads : {1, 2, 3, 8, 64}) EXPECT_EQ(pieces_of(33, 16, threads), expected) << threads;
    EXPECT_EQ(pieces_of(1, 16, 4), (Pieces{{0, 1}}));
    EXPECT_TRUE(pieces_of(0, 16, 4).empty());
}

TEST(Parallel, EveryWriteOfABodyIsVisibleAfterTheLoop) {
    std::vector<int> squares(10000);
    const Execution execution{4, {}};
    for (int round = 0; round < 20; ++round) {
        const Result<void> done = parallel_for(execution, 10000, 7, [&](int begin, int end) {
            for (int k = begin; k < end; ++k) squares[static_cast<std::size_t>(k)] = k * (k % 40) + round;
        });
        ASSERT_TRUE(done.has_value());
        for (int k = 0; k < 10000; ++k) ASSERT_EQ(squares[static_cast<std::size_t>(k)], k * (k % 40) + round);
    }
}

TEST(Parallel, SaysNothingWhereMoreThreadsAreWantedThanThereAreProcessors) {
    testing::internal::CaptureStderr();
    const Execution execution{1000, {}};
    EXPECT_TRUE(parallel_for(execution, 5000, 1, [](int, int) {}).has_value());
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(Parallel, ReportsTheEndEvenIfAnotherThreadWasReporting) {
    for (int round = 0; round < 50; ++round) {
        double last = 0.0;
        Execution execution{2, {}};
        execution.progress = [&](double fraction) {
            std::this_thread::sleep_for(std::chrono::microseconds(200));  // the other thread ends meanwhile
            last = fraction;
            return true;
        };
        ASSERT_TRUE(parallel_for(execution, 3, 1, [](int, int) {}).has_value());
        ASSERT_EQ(last, 1.0) << "round " << round;
    }
}

TEST(Parallel, ReportsProgressUpwardsWithinItsSpanAndFromOneThreadAtATime) {
    std::vector<double> seen;
    std::atomic<int> inside{0};
    Execution execution;
    execution.threads = 4;
    execution.progress = [&](double fraction) {
        EXPECT_EQ(inside.fetch_add(1), 0);
        seen.push_back(fraction);
        inside.fetch_sub(1);
        return true;
    };
    ASSERT_TRUE(parallel_for(execution, 1000, 10, [](int, int) {}, {0.25, 0.75}).has_value());
    ASSERT_FALSE(seen.empty());
    for (std::size_t k = 0; k < seen.size(); ++k) {
        EXPECT_GT(seen[k], k == 0 ? 0.25 : seen[k - 1]);
        EXPECT_LE(seen[k], 0.75);
    }
}

TEST(Parallel, StopsSoonWhenTheCallbackAsksTo) {
    for (const int threads : {1, 4}) {
        std::atomic<int> bodies{0};
        Execution execution;
        execution.threads = threads;
        execution.progress = [](double) { return false; };
        const Result<void> done = parallel_for(execution, 100000, 1, [&](int, int) { ++bodies; });
        ASSERT_FALSE(done.has_value());
        EXPECT_EQ(done.error().code, ErrorCode::cancelled);
        EXPECT_LT(bodies, 50000);
    }
}

TEST(Parallel, TurnsAFailedAllocationIntoAnError) {
    for (const int threads : {1, 4}) {
        const Execution execution{threads, {}};
        const Result<void> done = parallel_for(execution, 100, 1, [&](int begin, int) {
            if (begin == 50) throw std::bad_alloc();
        });
        ASSERT_FALSE(done.has_value());
        EXPECT_EQ(done.error().code, ErrorCode::out_of_memory);
    }
}

}  // namespace
}  // namespace tex
