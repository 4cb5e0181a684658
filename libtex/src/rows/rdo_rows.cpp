// SPDX-License-Identifier: Apache-2.0

#include "rows/rdo_rows.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>
#include <vector>

#include "rows/codecs.h"
#include "rows/rdo_astc_band.h"
#include "rows/rdo_astc_pass.h"
#include "rows/rdo_band.h"
#include "rows/rdo_budget.h"
#include "rows/rdo_pass.h"
#include "rows/rdo_rgb_band.h"
#include "rows/rdo_rgb_pass.h"
#include "rows/zstd_size.h"

namespace tex::inline v1 {
namespace {

constexpr double kMillionths = 1e6;

struct RdoPlan {
    std::vector<RdoGrowth> growths;  // of each part
    ByteCounts literals{};
};

// What a sample says about all runs: a run grows as the sampled one beside it does, but one sample is not much.
std::vector<double> spread_runs(const std::vector<double>& sampled, int stride, int runs) {
    double mean = 0.0;
    for (const double growth : sampled) mean += std::max(0.0, growth) / static_cast<double>(sampled.size());
    std::vector<double> growths;
    for (int run = 0; run < runs; ++run) {
        const std::size_t at = std::min(static_cast<std::size_t>(run / stride), sampled.size() - 1);
        growths.push_back(0.5 * (mean + std::max(0.0, sampled[at])));
    }
    return growths;
}

// Finds by samples the lambda of a part that spends `most` degrees more than its improved literals have.
class PartSearch {
public:
    PartSearch(const RdoBlocks& band, const RdoPart& part, double most)
        : runs_(rdo_runs(static_cast<std::size_t>(part.blocks))), stride_(rdo_sample_stride(runs_)),
          search_(sampled_part(part) * most, first_lambda(band, part, most)),
          growth_{search_.lambda(), search_.most_lambda(), search_.power(),
                  std::vector<double>(static_cast<std::size_t>(runs_))} {}

    [[nodiscard]] bool is_done() const { return search_.is_done(); }
    [[nodiscard]] RdoSampled next() const { return {search_.lambda(), is_done() ? 0 : stride_}; }
    // Returns whether the sample is the closest one so far.
    bool add(const std::vector<double>& sampled) {
        const float lambda = search_.lambda();
        double growth = 0.0;
        for (const double one : sampled) growth += one;
        if (!search_.add(growth)) return false;
        growth_ = {lambda, search_.most_lambda(), 0.0, spread_runs(sampled, stride_, runs_)};
        return true;
    }
    [[nodiscard]] RdoGrowth growth() const {
        RdoGrowth found = growth_;
        found.power = search_.power();
        return found;
    }

private:
    // The part of the blocks that a sample takes.
    [[nodiscard]] double sampled_part(const RdoPart& part) const {
        int sampled = 0;
        for (int run = 0; run < runs_; ++run) {
            if (is_sampled(run, stride_)) sampled += std::min(kRdoRun, part.blocks - kRdoRun * run);
        }
        return static_cast<double>(sampled) / static_cast<double>(part.blocks);
    }
    // A good one: the mean angle that is allowed, shared among the bits that are usually saved.
    static double first_lambda(const RdoBlocks& band, const RdoPart& part, double most) {
        const double allowed = most / part.texels, mean = part.improved_sum / part.texels;
        const double texels = static_cast<double>(band.block_texels) / 16.0;
        return texels * 0.6 * std::sqrt(allowed * (mean + 0.1 * allowed));
    }

    const int runs_, stride_;
    RdoLambdaSearch search_;
    RdoGrowth growth_;
};

// Finds how to spend `most` degrees in each part.
RdoPlan plan_of(const RdoBlocks& band, const RdoMakeRuns& make, const std::vector<double>& most) {
    std::vector<PartSearch> searches;
    searches.reserve(band.parts.size());
    for (std::size_t k = 0; k < band.parts.size(); ++k) searches.emplace_back(band, band.parts[k], most[k]);
    RdoPlan plan;
    for (const std::byte byte : band.plain) ++plan.literals[std::to_integer<std::size_t>(byte)];
    constexpr int kMostSamples = 5;
    const auto is_done = [](const PartSearch& search) { return search.is_done(); };
    for (int k = 0; k < kMostSamples && !std::all_of(searches.begin(), searches.end(), is_done); ++k) {
        std::vector<RdoSampled> parts;
        for (const PartSearch& search : searches) parts.push_back(search.next());
        const RdoSample sample = make(plan.literals)->sample(parts);
        bool is_closest = false;
        for (std::size_t part = 0; part < parts.size(); ++part)
            is_closest = (parts[part].stride > 0 && searches[part].add(sample.growths[part])) || is_closest;
        if (is_closest) plan.literals = sample.literals;
    }
    for (const PartSearch& search : searches) plan.growths.push_back(search.growth());
    return plan;
}

// A result and its size.
struct Optimised {
    RdoResult result;
    std::size_t size;
};

// Whether what zstd -19 makes of the result is smaller than what it makes of the plain blocks. Where a fast level saves
// much, so does -19; otherwise it takes a try: the rate is an estimate, and where copies are dear, what it saves may be
// less than nothing.
bool is_gain(const RdoBlocks& band, const Optimised& best, std::size_t plain_size) {
    if (!best.result.is_whole) return false;
    if (static_cast<double>(best.size) < 0.95 * static_cast<double>(plain_size)) return true;
    return zstd_size(best.result.blocks) < zstd_size(band.plain);
}

// Spends `most` degrees of each part. The result is not whole if nothing is gained.
Optimised optimise(const RdoBlocks& band, const RdoMakeRuns& make, const std::vector<double>& most) {
    RdoPlan plan = plan_of(band, make, most);
    constexpr int kFastLevel = 5;
    const std::size_t plain_size = zstd_size(band.plain, kFastLevel);
    Optimised best{{}, plain_size + plain_size / 50};
    constexpr int kMostPasses = 3;
    for (int pass = 1; pass <= kMostPasses; ++pass) {
        std::vector<RdoBudget> budgets;
        for (std::size_t k = 0; k < most.size(); ++k) budgets.emplace_back(plan.growths[k], most[k]);
        RdoResult result = make(plan.literals)->run(budgets, pass == 1);
        std::vector<bool> wandered;
        for (std::size_t k = 0; k < most.size(); ++k) {
            wandered.push_back(budgets[k].has_wandered());
            plan.growths[k] = budgets[k].better_plan(result.growths[k]);
        }
        plan.literals = result.literals;
        const bool has_wandered = !result.is_whole || is_half(band, wandered);
        if (result.is_whole) {
            const std::size_t size = zstd_size(result.blocks, kFastLevel);
            if (size >= best.size) break;
            best = {std::move(result), size};
        }
        if (!has_wandered) break;
    }
    if (!is_gain(band, best, plain_size)) best.result.is_whole = false;
    return best;
}

void optimise_blocks(const RdoBlocks& band, const RdoMakeRuns& make, const PackOptions& options, std::byte* blocks,
                     RdoTally* tally) {
    std::vector<double> most;
    for (const RdoPart& part : band.parts)
        most.push_back(static_cast<double>(options.rdo.mean) * part.texels + part.plain_sum - part.improved_sum);
    const Optimised best = optimise(band, make, most);
    const bool is_plain = !best.result.is_whole;
    if (!is_plain) std::copy(best.result.blocks.begin(), best.result.blocks.end(), blocks);
    if (tally == nullptr) return;
    RdoTally::Band sums{0, 0, 0, 0.0, is_plain ? 0.0 : best.result.most_raised};
    for (std::size_t k = 0; k < band.parts.size(); ++k) {
        const RdoPart& part = band.parts[k];
        const double sum = is_plain ? part.plain_sum : part.improved_sum + best.result.growths[k];
        sums.texels += static_cast<std::int64_t>(part.texels);
        sums.plain += std::llround(kMillionths * part.plain_sum);
        sums.optimised += std::llround(kMillionths * sum);
        sums.most_growth = std::max(sums.most_growth, (sum - part.plain_sum) / part.texels);
    }
    tally->add(sums);
}

}  // namespace

void RdoTally::add(const Band& band) {
    const std::lock_guard lock(mutex_);
    sum_.texels += band.texels;
    sum_.plain += band.plain;
    sum_.optimised += band.optimised;
    sum_.most_growth = std::max(sum_.most_growth, band.most_growth);
    sum_.most_raised = std::max(sum_.most_raised, band.most_raised);
}

void RdoTally::take_plain() {
    const std::lock_guard lock(mutex_);
    sum_ = {sum_.texels, sum_.plain, sum_.plain, 0.0, 0.0};
}

RdoTally::Band RdoTally::sum() const {
    const std::lock_guard lock(mutex_);
    return sum_;
}

RdoReport report_of(const RdoTally::Band& sum) {
    const double all = kMillionths * static_cast<double>(std::max<std::int64_t>(1, sum.texels));
    return {static_cast<double>(sum.plain) / all, static_cast<double>(sum.optimised) / all, sum.most_growth,
            sum.most_raised};
}

RdoReport RdoTallies::report() const {
    RdoTally all;
    for (const RdoTally& level : levels_) all.add(level.sum());
    return report_of(all.sum());
}

bool is_optimised(const PackOptions& options) { return can_optimise(options.encoding) && options.rdo.mean > 0.0f; }

int rdo_band_rows(const PackOptions& options, int base_width) {
    constexpr std::int64_t kBandBlocks = 16384;
    constexpr int kBandTexels = 64;  // lower parts of squares are too small for budgets
    const Extent block = format_info(encoding_info(options.encoding).format).block;
    if (!is_optimised(options)) return kBlockEdge;
    int rows = 1;
    while (std::int64_t{rows} * blocks_across(base_width, block.width) < kBandBlocks ||
           rows * block.height < kBandTexels)
        rows *= 2;
    return block.height * rows;
}

void optimise_band(const std::function<BlockRow(int row)>& rows, int count, Extent level, int first,
                   const PackOptions& options, std::byte* blocks, RdoTally* tally) {
    assert(is_optimised(options) && codec_of(options.encoding).encode_halves != nullptr);
    const RdoBand band = read_band(rows, count, level, first, options, blocks);
    optimise_blocks(
        band, [&band](const ByteCounts& literals) { return rdo_pass(band, literals); }, options, blocks, tally);
}

void optimise_astc_band(const float* xy, int height, Extent level, int first, const PackOptions& options,
                        std::byte* blocks, RdoTally* tally) {
    assert(is_optimised(options) && whole_blocks(options.encoding) != nullptr);
    const RdoAstcBand band = read_astc_band(xy, height, level, first, options, blocks);
    optimise_blocks(
        band, [&band](const ByteCounts& literals) { return rdo_astc_pass(band, literals); }, options, blocks, tally);
}

void optimise_rgb_band(const float* texels, int height, Extent level, int first, const PackOptions& options,
                       std::byte* blocks, RdoTally* tally) {
    assert(is_optimised(options) && whole_blocks(options.encoding) != nullptr);
    const RdoRgbBand band = read_rgb_band(texels, height, level, first, options, blocks);
    optimise_blocks(
        band, [&band](const ByteCounts& literals) { return rdo_rgb_pass(band, literals); }, options, blocks, tally);
}

}  // namespace tex::inline v1
