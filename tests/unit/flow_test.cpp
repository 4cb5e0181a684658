// SPDX-License-Identifier: Apache-2.0
// The flow of rows from sources through stages to targets, with stages made for the purpose.

#include "stream/flow.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace tex {
namespace {

constexpr Extent kExtent{4, 400};
constexpr int kRows = 4;  // of a strip, with these sizes:
const StreamSizes kSizes{kRows * kExtent.width, 0, kRows* kExtent.width};

// Row j holds j.
class Numbers final : public Stage {
public:
    explicit Numbers(bool in_order) : Stage(kExtent, 1), in_order_(in_order) {}

    [[nodiscard]] std::vector<Need> needs(int, int) const override { return {}; }
    [[nodiscard]] bool reads() const override { return true; }
    [[nodiscard]] bool in_order() const override { return in_order_; }
    [[nodiscard]] bool counts() const override { return true; }
    Result<void> make(Strip& strip) override {
        if (in_order_) {
            EXPECT_EQ(strip.first, next_);
            next_ = strip.first + strip.height;
        }
        if (std::count(fails_.begin(), fails_.end(), strip.first) > 0)
            return Error{ErrorCode::bad_data, {}, "row " + std::to_string(strip.first)};
        for (int k = 0; k < strip.height; ++k)
            std::fill_n(strip.row(0, k), kExtent.width, static_cast<float>(strip.first + k));
        ++made;
        return {};
    }
    void fail_at(std::vector<int> rows) { fails_ = std::move(rows); }

    std::atomic<int> made = 0;

private:
    const bool in_order_;
    int next_ = 0;
    std::vector<int> fails_;
};

// Row j is the sum of rows j - reach to j + reach of a texture that repeats.
class Sums final : public Stage {
public:
    Sums(const Stage& from, int reach) : Stage(kExtent, 1), from_(from), reach_(reach) {}

    [[nodiscard]] std::vector<Need> needs(int first, int end) const override {
        std::vector<Need> needs;
        for (int j = first - reach_; j < end + reach_; ++j) needs.push_back({&from_, around(j), around(j) + 1});
        return needs;
    }
    Result<void> make(Strip& strip) override {
        for (int k = 0; k < strip.height; ++k) {
            float sum = 0.0f;
            for (int d = -reach_; d <= reach_; ++d) sum += from_.row(0, around(strip.first + k + d))[0];
            std::fill_n(strip.row(0, k), kExtent.width, sum);
        }
        return {};
    }

private:
    static int around(int j) { return (j + 10 * kExtent.height) % kExtent.height; }

    const Stage& from_;
    const int reach_;
};

// Keeps what it is given, in the order in which it comes.
class Collector final : public Stage {
public:
    Collector(const Stage& from, bool in_order) : Stage(kExtent, 0), from_(from), in_order_(in_order) {}

    [[nodiscard]] std::vector<Need> needs(int first, int end) const override { return {{&from_, first, end}}; }
    [[nodiscard]] bool in_order() const override { return in_order_; }
    Result<void> make(Strip& strip) override {
        if (before_each) before_each(strip.first);
        const std::lock_guard lock(mutex_);
        order.push_back(strip.first);
        for (int j = strip.first; j < strip.first + strip.height; ++j)
            values[static_cast<std::size_t>(j)] = from_.row(0, j)[0];
        return {};
    }

    std::function<void(int first)> before_each;
    std::vector<float> values = std::vector<float>(static_cast<std::size_t>(kExtent.height), -1.0f);
    std::vector<int> order;

private:
    const Stage& from_;
    const bool in_order_;
    std::mutex mutex_;
};

float sum_around(int j, int reach) {
    float sum = 0.0f;
    for (int d = -reach; d <= reach; ++d) sum += static_cast<float>((j + d + 10 * kExtent.height) % kExtent.height);
    return sum;
}

TEST(Flow, MakesEveryRowFromTheRowsThatItReaches) {
    for (const int threads : {1, 2, 3}) {
        for (const bool in_order : {false, true}) {
            for (const int reach : {0, 1, 5, 60}) {
                Flow flow;
                Numbers& numbers = flow.add<Numbers>(in_order);
                Sums& sums = flow.add<Sums>(numbers, reach);
                Sums& again = flow.add<Sums>(sums, 0);
                Collector& target = flow.add<Collector>(again, in_order);
                ASSERT_TRUE(flow.run({threads, {}}, kSizes));
                for (int j = 0; j < kExtent.height; ++j)
                    ASSERT_EQ(target.values[static_cast<std::size_t>(j)], sum_around(j, reach)) << j;
                EXPECT_EQ(target.order.size(), static_cast<std::size_t>(kExtent.height / kRows));
            }
        }
    }
}

// The first rows wait for the last ones; the others do not wait for them, though the target takes one at a time.
TEST(Flow, RowsThatWaitForTheLastOnesComeLast) {
    for (const int threads : {1, 2}) {
        Flow flow;
        Numbers& numbers = flow.add<Numbers>(true);
        Sums& sums = flow.add<Sums>(numbers, 1);
        Collector& target = flow.add<Collector>(sums, true);
        int most_ahead = 0;
        target.before_each = [&](int first) {
            if (first > 0) most_ahead = std::max(most_ahead, numbers.made * kRows - first);
        };
        ASSERT_TRUE(flow.run({threads, {}}, kSizes));
        EXPECT_EQ(target.order.front(), kRows);
        EXPECT_LE(most_ahead, (threads + 5) * kRows);
    }
}

// A slow target holds up what reads, so that few strips exist at a time.
TEST(Flow, ReadsNotFarAheadOfASlowTarget) {
    for (const bool in_order : {false, true}) {
        Flow flow;
        Numbers& numbers = flow.add<Numbers>(in_order);
        Collector& target = flow.add<Collector>(numbers, true);
        int most_ahead = 0;
        target.before_each = [&](int first) {
            std::this_thread::sleep_for(std::chrono::microseconds(200));
            most_ahead = std::max(most_ahead, numbers.made * kRows - first);
        };
        ASSERT_TRUE(flow.run({3, {}}, kSizes));
        EXPECT_LE(most_ahead, (3 + 4) * kRows);
    }
}

TEST(Flow, ReportsTheErrorOfTheTopmostRow) {
    for (int round = 0; round < 20; ++round) {
        Flow flow;
        Numbers& numbers = flow.add<Numbers>(false);
        numbers.fail_at({240, 120, 124, 128, 396});
        flow.add<Collector>(numbers, false);
        const Result<void> done = flow.run({3, {}}, kSizes);
        ASSERT_FALSE(done);
        EXPECT_EQ(done.error().reason, "row 120");
    }
}

TEST(Flow, OnlyCountsWhenAStageSaysSo) {
    Flow flow;
    Numbers& numbers = flow.add<Numbers>(false);
    Collector& target = flow.add<Collector>(numbers, false);
    flow.only_count();
    ASSERT_TRUE(flow.run({2, {}}, kSizes));
    EXPECT_EQ(numbers.made, kExtent.height / kRows);
    EXPECT_TRUE(target.order.empty());
}

TEST(Flow, ProgressNeverFallsAndEndsAtOne) {
    for (const int threads : {1, 3}) {
        Flow flow;
        Numbers& numbers = flow.add<Numbers>(true);
        flow.add<Collector>(flow.add<Sums>(numbers, 2), false);
        double last = 0.0;
        const Execution execution{threads, [&last](double fraction) {
                                      EXPECT_GE(fraction, last);
                                      last = fraction;
                                      return true;
                                  }};
        ASSERT_TRUE(flow.run(execution, kSizes));
        EXPECT_EQ(last, 1.0);
    }
}

TEST(Flow, StopsWhenItIsCancelled) {
    Flow flow;
    Numbers& numbers = flow.add<Numbers>(false);
    Collector& target = flow.add<Collector>(numbers, false);
    const Result<void> done = flow.run({2, [](double fraction) { return fraction < 0.5; }}, kSizes);
    ASSERT_FALSE(done);
    EXPECT_EQ(done.error().code, ErrorCode::cancelled);
    EXPECT_LT(target.order.size(), static_cast<std::size_t>(kExtent.height / kRows));
}

}  // namespace
}  // namespace tex
