// SPDX-License-Identifier: Apache-2.0

#include "rows/rdo_rows.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>
#include <vector>

#include "blocks/block_half.h"
#include "rows/rdo_astc_band.h"
#include "rows/rdo_astc_pass.h"
#include "rows/rdo_band.h"
#include "rows/rdo_budget.h"
#include "rows/rdo_pass.h"
#include "rows/zstd_size.h"

namespace tex::inline v1 {
namespace {

constexpr double kMillionths = 1e6;

struct RdoPlan {
    RdoGrowth growth;
    ByteCounts literals;
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

// Finds by samples how to spend `most` degrees more than the improved literals have.
RdoPlan plan_of(const RdoBlocks& band, const RdoMakeRuns& make, double most) {
    const int runs = rdo_runs(band.count());
    const int stride = rdo_sample_stride(runs);
    std::size_t sampled = 0;
    for (int run = 0; run < runs; ++run) {
        const std::size_t first = std::size_t{kRdoRun} * static_cast<std::size_t>(run);
        if (is_sampled(run, stride)) sampled += std::min<std::size_t>(kRdoRun, band.count() - first);
    }
    const double part = static_cast<double>(sampled) / static_cast<double>(band.count());
    // A good first lambda: the mean angle that is allowed, shared among the bits that are usually saved.
    const double allowed = most / band.texels;
    const double mean = band.improved_sum / band.texels;
    const double texels = static_cast<double>(band.block_texels) / 16.0;
    RdoLambdaSearch search(part * most, texels * 0.6 * std::sqrt(allowed * (mean + 0.1 * allowed)));
    ByteCounts plain{};
    for (const std::byte byte : band.plain) ++plain[std::to_integer<std::size_t>(byte)];
    RdoPlan plan{
        {search.lambda(), search.most_lambda(), search.power(), std::vector<double>(static_cast<std::size_t>(runs))},
        plain};
    constexpr int kMostSamples = 5;
    for (int k = 0; k < kMostSamples && !search.is_done(); ++k) {
        const float lambda = search.lambda();
        const RdoSample sample = make(plan.literals)->sample(lambda, stride);
        double growth = 0.0;
        for (const double one : sample.growths) growth += one;
        if (search.add(growth))
            plan = {{lambda, search.most_lambda(), 0.0, spread_runs(sample.growths, stride, runs)}, sample.literals};
    }
    plan.growth.power = search.power();
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

// Spends `most` degrees. The result is not whole if nothing is gained.
Optimised optimise(const RdoBlocks& band, const RdoMakeRuns& make, double most) {
    RdoPlan plan = plan_of(band, make, most);
    constexpr int kFastLevel = 5;
    const std::size_t plain_size = zstd_size(band.plain, kFastLevel);
    Optimised best{{}, plain_size + plain_size / 50};
    constexpr int kMostPasses = 3;
    for (int pass = 1; pass <= kMostPasses; ++pass) {
        RdoBudget budget(plan.growth, most);
        RdoResult result = make(plan.literals)->run(budget, pass == 1);
        const bool has_wandered = budget.has_wandered();
        plan = {budget.better_plan(result.growth), result.literals};
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
    const double most = static_cast<double>(options.rdo.mean) * band.texels;
    const Optimised best = optimise(band, make, most + band.plain_sum - band.improved_sum);
    double sum = band.plain_sum;
    double most_raised = 0.0;
    if (best.result.is_whole) {
        std::copy(best.result.blocks.begin(), best.result.blocks.end(), blocks);
        sum = band.improved_sum + best.result.growth;
        most_raised = best.result.most_raised;
    }
    if (tally == nullptr) return;
    tally->add({static_cast<std::int64_t>(band.texels), std::llround(kMillionths * band.plain_sum),
                std::llround(kMillionths * sum), (sum - band.plain_sum) / band.texels, most_raised});
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
    const Extent block = format_info(encoding_info(options.encoding).format).block;
    if (!is_optimised(options)) return kBlockEdge;
    int rows = 1;
    while (std::int64_t{rows} * blocks_across(base_width, block.width) < kBandBlocks) rows *= 2;
    return block.height * rows;
}

void optimise_band(const std::function<BlockRow(int row)>& rows, int count, const PackOptions& options,
                   std::byte* blocks, RdoTally* tally) {
    assert(is_optimised(options) && has_halves(options.encoding));
    const RdoBand band = read_band(rows, count, options, blocks);
    optimise_blocks(
        band, [&band](const ByteCounts& literals) { return rdo_pass(band, literals); }, options, blocks, tally);
}

void optimise_astc_band(const float* xy, Extent extent, const PackOptions& options, std::byte* blocks,
                        RdoTally* tally) {
    assert(is_optimised(options) && !has_halves(options.encoding));
    const RdoAstcBand band = read_astc_band(xy, extent, options, blocks);
    optimise_blocks(
        band, [&band](const ByteCounts& literals) { return rdo_astc_pass(band, literals); }, options, blocks, tally);
}

}  // namespace tex::inline v1
