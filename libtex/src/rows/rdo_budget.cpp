// SPDX-License-Identifier: Apache-2.0

#include "rows/rdo_budget.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "rows/math.h"

namespace tex::inline v1 {
namespace {

constexpr double kTarget = 0.99;                          // of the growth that is allowed
constexpr double kLeastFactor = 0.25, kMostFactor = 4.0;  // by which a pass changes lambda
// A pass is repeated if lambda changes by more than this between any two runs, or is off the plan by more than this
// after the first part of the runs.
constexpr double kMostWandering = 1.25;
constexpr double kMostOff = 1.1;
constexpr double kSurePower = 1.5;  // of single runs, whose powers differ
constexpr double kSlowly = 0.2;     // of the whole growth
constexpr std::size_t kFirstPart = 5;
constexpr std::size_t kManyRuns = 64;  // the first part of fewer is not like the others

double power_of(double base, double exponent) { return base <= 0.0 ? 0.0 : math::pow(base, exponent); }

}  // namespace

int rdo_runs(std::size_t blocks) { return static_cast<int>((blocks + kRdoRun - 1) / kRdoRun); }

int rdo_sample_stride(int runs) { return std::clamp(runs / 8, 1, 8); }

bool RdoLambdaSearch::add(double growth) {
    constexpr double kClose = 0.15;
    const double ratio = growth / most_;
    const double off = std::abs(ratio - 1.0);
    const bool is_closest = off < closest_;
    closest_ = std::min(closest_, off);
    is_done_ = off < kClose || (ratio < 1.0 && lambda_ >= most_lambda_);
    if (last_.growth > 0.0 && growth > 0.0 && last_.growth != growth) {
        const double measured = math::log(growth / last_.growth) / math::log(lambda_ / last_.lambda);
        power_ = std::clamp(measured, 1.0, 4.0);
    }
    last_ = {lambda_, growth};
    (ratio <= 1.0 ? low_ : high_) = last_;
    if (low_.lambda == 0.0 || high_.lambda == 0.0) {
        lambda_ *= std::clamp(power_of(1.0 / std::max(ratio, 1e-3), 1.0 / power_), 0.3, 3.0);
    } else {
        // Between both, where a straight line reaches the limit, but not too close to either.
        const double part = (most_ - low_.growth) / (high_.growth - low_.growth);
        lambda_ = low_.lambda + std::clamp(part, 0.1, 0.9) * (high_.lambda - low_.lambda);
    }
    lambda_ = std::min(lambda_, most_lambda_);
    return is_closest;
}

RdoBudget::RdoBudget(RdoGrowth plan, double most) : plan_(std::move(plan)), most_(most) {
    for (double& growth : plan_.runs) {
        growth = std::max(growth, 1e-6 * most / static_cast<double>(plan_.runs.size()));
        rest_ += growth;
    }
    trust_ = 0.03 * rest_;
}

void RdoBudget::end_run(double growth) {
    if (factors_.empty()) return;
    growths_.push_back(growth - before_);
    const double planned = plan_.runs[growths_.size() - 1];
    done_ += planned * power_of(factors_.back(), plan_.power);
    rest_ -= planned;
}

float RdoBudget::next(double growth) {
    end_run(growth);
    before_ = growth;
    const double more = (std::max(0.0, growth) + trust_) / (done_ + trust_);
    const double rest = std::max(rest_, plan_.runs[factors_.size()]);
    const double off = (kTarget * most_ - growth) / more - rest;
    // What is left is spent slowly: the last few runs cannot make up for all others.
    const double ratio = 1.0 + off / (off > 0.0 ? std::max(rest, kSlowly * (done_ + rest)) : rest);
    const double factor = power_of(ratio, 1.0 / plan_.power);
    const double most = std::min(kMostFactor, static_cast<double>(plan_.most_lambda / plan_.lambda));
    factors_.push_back(std::max(kLeastFactor, std::min(factor, most)));
    return plan_.lambda * static_cast<float>(factors_.back());
}

bool RdoBudget::has_wandered() const {
    if (factors_.empty()) return false;  // the pass has stopped before it came to this part
    // The last runs have little left to correct with, and weigh little.
    const std::size_t all = plan_.runs.size();
    const std::size_t last = std::min(factors_.size(), all - all / 6);
    const auto [least, greatest] =
        std::minmax_element(factors_.begin(), factors_.begin() + static_cast<std::ptrdiff_t>(last));
    if (factors_.size() == all) return *greatest > kMostWandering * *least;
    const double off = std::max(factors_.back(), 1.0 / factors_.back());
    return all >= kManyRuns && factors_.size() == all / kFirstPart + 1 && off > kMostOff;
}

RdoGrowth RdoBudget::better_plan(double growth) {
    end_run(growth);
    const double more = (std::max(0.0, growth) + trust_) / (done_ + trust_);
    RdoGrowth better{0.0f, plan_.most_lambda, plan_.power, plan_.runs};
    double sum = 0.0;
    for (std::size_t run = 0; run < better.runs.size(); ++run) {
        double& at = better.runs[run];
        if (run < growths_.size()) {
            at = std::max(0.0, growths_[run]) / power_of(factors_[run], std::min(kSurePower, plan_.power));
        } else {
            at *= more;
        }
        sum += at;
    }
    // At this factor of lambda, the sum is what is allowed.
    const double factor = std::clamp(power_of(kTarget * most_ / std::max(sum, 1e-6 * most_), 1.0 / plan_.power),
                                     kLeastFactor, kMostFactor);
    better.lambda = std::min(plan_.most_lambda, plan_.lambda * static_cast<float>(factor));
    for (double& at : better.runs) at *= power_of(factor, plan_.power);
    return better;
}

}  // namespace tex::inline v1
