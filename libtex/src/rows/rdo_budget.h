// SPDX-License-Identifier: Apache-2.0
// rdo_budget.h: which lambda spends the growth of the sum of angles that is allowed.
//
// The growth rises steeply with lambda, about as a power of it. So passes over a sample of the blocks search for a
// lambda first. Then a pass over all blocks follows the plan that the closest sample gives, and corrects lambda where
// the sum grows more or less than planned. If lambda has to change much on the way, another pass begins, with a plan
// made from the one before. Growth is counted from the improved literals, which are what a lambda of 0 writes, so that
// a block that would exceed the limit can always stay as it is.

#pragma once

#include <cstddef>
#include <vector>

namespace tex::inline v1 {

// Passes take blocks in runs; a sample takes one of `stride` runs.
inline constexpr int kRdoRun = 128;
[[nodiscard]] int rdo_runs(std::size_t blocks);
[[nodiscard]] int rdo_sample_stride(int runs);
[[nodiscard]] constexpr bool is_sampled(int run, int stride) { return run % stride == stride / 2; }

// How the sum of angles grows at a lambda, run by run.
struct RdoGrowth {
    float lambda;
    float most_lambda;  // beyond it, the angles grow, and hardly a bit is saved
    double power;       // of lambda
    std::vector<double> runs;
};

// Searches for the lambda whose growth over a sample is close to what is allowed.
class RdoLambdaSearch {
public:
    // `most` is the growth that is allowed for the sample; `first` is where the search begins.
    RdoLambdaSearch(double most, double first) : most_(most), most_lambda_(6.0 * first), lambda_(first) {}

    [[nodiscard]] float lambda() const { return static_cast<float>(lambda_); }
    [[nodiscard]] float most_lambda() const { return static_cast<float>(most_lambda_); }
    // Says how a sample with lambda() has grown. Returns whether it is the closest one so far.
    bool add(double growth);
    [[nodiscard]] bool is_done() const { return is_done_; }
    // The power of lambda with which the growth rises close to the limit.
    [[nodiscard]] double power() const { return power_; }

private:
    struct Tried {
        double lambda, growth;
    };
    const double most_, most_lambda_;
    double lambda_;
    Tried low_{0.0, 0.0};   // kept the limit
    Tried high_{0.0, 0.0};  // did not
    Tried last_{0.0, 0.0};
    double power_ = 2.5;
    double closest_ = 1e300;
    bool is_done_ = false;
};

// The plan of a pass over all blocks, and how it goes.
class RdoBudget {
public:
    RdoBudget(RdoGrowth plan, double most);

    // The lambda of the next run, after all runs before have grown by `growth` in all.
    float next(double growth);
    [[nodiscard]] bool allows(double growth) const { return growth <= most_; }
    // Whether lambda had to change so much that a better plan is worth another pass. Says so early if it can: after the
    // first runs, or after the last one.
    [[nodiscard]] bool has_wandered() const;
    // A better plan, after the runs so far have grown by `growth`.
    [[nodiscard]] RdoGrowth better_plan(double growth);

private:
    void end_run(double growth);

    RdoGrowth plan_;
    double most_;
    double rest_ = 0.0;            // planned for the runs to come
    double trust_ = 0.0;           // how much growth the plan counts as seen at the start
    double done_ = 0.0;            // planned for the runs before, at the lambdas that they had
    double before_ = 0.0;          // the growth when the last run began
    std::vector<double> factors_;  // of lambda, for each run so far
    std::vector<double> growths_;
};

}  // namespace tex::inline v1
