// SPDX-License-Identifier: Apache-2.0

#include "rows/rdo_rows.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>
#include <vector>

#include "blocks/half_block.h"
#include "kernels/angle_search.h"
#include "kernels/copy_search.h"
#include "rows/math.h"
#include "rows/rdo_pass.h"
#include "rows/zstd_size.h"

namespace tex {
namespace {

constexpr std::ptrdiff_t kBytes = 16;  // of a block
constexpr double kMillionths = 1e6;
constexpr double kDegreesOfRadian = 180.0 / math::kPi;

double degrees_of(float chord) {
    const double half = std::min(1.0, 0.5 * static_cast<double>(chord));
    return half >= 1.0 ? 180.0 : 2.0 * kDegreesOfRadian * math::atan(half / std::sqrt(1.0 - half * half));
}

// The longest chord whose angle, as degrees_of() computes it, is not above `degrees`.
float chord_of(float degrees) {
    constexpr double kJustBelow = 1.0 - 1e-6;
    if (degrees >= 180.0f) return 2.0f;
    return static_cast<float>(2.0 * math::sin(0.5 * static_cast<double>(degrees) / kDegreesOfRadian) * kJustBelow);
}

float clamped(float n) { return std::fmin(std::fmax(n, -1.0f), 1.0f); }

// The chords between the texels of a block and what 16 bytes decode to.
void chords_of(const RdoBand& band, const std::vector<std::byte>& blocks, std::size_t index, float chords[16]) {
    const RdoBlock& block = band.blocks[index];
    const std::byte* const bytes = blocks.data() + kBytes * static_cast<std::ptrdiff_t>(index);
    const float* const normals[3] = {block.x, block.y, block.z};
    float x[16], y[16];
    decode_half(half_kind(band.encoding, 0), bytes, x);
    decode_half(half_kind(band.encoding, 1), bytes + kHalfBytes, y);
    block_chords(normals, x, y, chords);
}

// Adds block `index` of a row.
void add_block(const BlockRow& row, int index, RdoBand& band) {
    RdoBlock block;
    for (int k = 0; k < kBlockTexels; ++k) {
        const int i = kBlockEdge * index + k % kBlockEdge;
        const int j = k / kBlockEdge;
        const int column = std::min(i, row.width - 1);
        const float x = clamped(row.x[j][column]);
        const float y = clamped(row.y[j][column]);
        const float flat = x * x + y * y;
        const float factor = 1.0f / std::sqrt(std::max(1.0f, flat));
        block.x[k] = factor * x;
        block.y[k] = factor * (row.negate_y ? -y : y);
        block.z[k] = std::sqrt(1.0f - std::min(1.0f, flat));
        block.inside[k] = i < row.width && j < row.height ? 1.0f : 0.0f;
    }
    band.blocks.push_back(block);
}

struct Angles {
    double sum = 0.0;  // degrees, of the texels in the level
    double most_raised = 0.0;
};

Angles measure(const RdoBand& band, const std::vector<std::byte>& blocks, const std::vector<float>& plain) {
    Angles angles;
    for (std::size_t index = 0; index < band.blocks.size(); ++index) {
        float chords[16];
        chords_of(band, blocks, index, chords);
        for (std::size_t k = 0; k < 16; ++k) {
            if (band.blocks[index].inside[k] == 0.0f) continue;
            const double angle = degrees_of(chords[k]);
            angles.sum += angle;
            if (chords[k] > plain[16 * index + k]) angles.most_raised = std::max(angles.most_raised, angle);
        }
    }
    return angles;
}

// Reads the band. Returns the chords of the plain blocks.
std::vector<float> read_band(const std::function<BlockRow(int row)>& rows, int count, const PackOptions& options,
                             const std::byte* blocks, RdoBand& band) {
    band.encoding = options.encoding;
    band.window = options.rdo.window;
    for (int r = 0; r < count; ++r) {
        const BlockRow row = rows(r);
        const int across = blocks_across(row.width);
        for (int b = 0; b < across; ++b) add_block(row, b, band);
        const std::ptrdiff_t pitch = kBytes * across;
        band.plain.insert(band.plain.end(), blocks + r * pitch, blocks + (r + 1) * pitch);
        band.improved.insert(band.improved.end(), blocks + r * pitch, blocks + (r + 1) * pitch);
        const bool is_eac = keeps_slope(half_kind(band.encoding, 0));
        if (!is_eac) improve_angles(row, options.encoding, band.improved.data() + r * pitch);
    }
    std::vector<float> plain(16 * band.blocks.size());
    for (std::size_t index = 0; index < band.blocks.size(); ++index)
        chords_of(band, band.plain, index, plain.data() + 16 * index);
    return plain;
}

// Sets how long the chords of all texels may get: `longest`, or as long as they are without optimisation.
void set_limits(const std::vector<float>& plain, float longest, RdoBand& band) {
    for (std::size_t index = 0; index < band.blocks.size(); ++index) {
        RdoBlock& block = band.blocks[index];
        for (std::size_t k = 0; k < 16; ++k)
            block.most[k] = block.inside[k] == 0.0f ? 1e30f : std::max(longest, plain[16 * index + k]);
    }
}

// Searches for the greatest lambda whose pass keeps the mean: the growth of the sum of angles rises with lambda, almost
// always. Passes are expensive, so the search ends as soon as the growth is close to the limit.
class LambdaSearch {
public:
    // `most` is the greatest growth; `first` is where the search begins.
    LambdaSearch(double most, double first) : most_(most), lambda_(first) {}

    [[nodiscard]] float lambda() const { return static_cast<float>(lambda_); }

    // Says how a pass with lambda() has grown. Returns whether it is the best pass that keeps the limit.
    bool add(double growth) {
        constexpr double kClose = 0.97;
        const bool kept = growth <= most_;
        is_done_ = kept && growth > kClose * most_;
        if (kept) {
            low_ = lambda_;
            low_growth_ = growth;
        } else {
            high_ = lambda_;
            high_growth_ = growth;
        }
        if (high_ == 0.0) {
            lambda_ *= growth > 0.0 ? std::clamp(most_ / growth, 1.2, 3.0) : 3.0;
        } else if (low_ == 0.0) {
            lambda_ *= std::clamp(0.9 * most_ / growth, 0.2, 0.8);
        } else {
            // Between both, where a straight line reaches the limit, but not too close to either.
            const double part = (0.985 * most_ - low_growth_) / (high_growth_ - low_growth_);
            lambda_ = low_ + std::clamp(part, 0.1, 0.9) * (high_ - low_);
        }
        return kept;
    }
    [[nodiscard]] bool is_done() const { return is_done_ || lambda_ > 1e4; }

private:
    const double most_;
    double lambda_;
    double low_ = 0.0, low_growth_ = 0.0;    // kept the limit
    double high_ = 0.0, high_growth_ = 0.0;  // did not
    bool is_done_ = false;
};

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
    int rows = 1;
    if (is_optimised(options)) {
        while (std::int64_t{rows} * blocks_across(base_width) < kBandBlocks) rows *= 2;
    }
    return kBlockEdge * rows;
}

void optimise_band(const std::function<BlockRow(int row)>& rows, int count, const PackOptions& options,
                   std::byte* blocks, RdoTally* tally) {
    assert(is_optimised(options));
    RdoBand band;
    const std::vector<float> plain = read_band(rows, count, options, blocks, band);
    double texels = 0.0;
    for (const RdoBlock& block : band.blocks) {
        for (const float inside : block.inside) texels += static_cast<double>(inside);
    }
    const double plain_sum = measure(band, band.plain, plain).sum;
    const double most = static_cast<double>(options.rdo.mean) * texels;

    // A good first lambda: the mean angle that is allowed, shared among the bits that are usually saved.
    const double mean = plain_sum / texels;
    const auto allowed = static_cast<double>(options.rdo.mean);
    const auto usual_max = static_cast<float>(std::min(180.0, kRdoMaxOfMean * (mean + allowed)));
    set_limits(plain, chord_of(options.rdo.max > 0.0f ? options.rdo.max : usual_max), band);
    LambdaSearch search(most, 0.36 * std::sqrt(allowed * (mean + 0.1 * allowed)));
    ByteCounts literals{};
    for (const std::byte byte : band.plain) ++literals[std::to_integer<std::size_t>(byte)];
    Angles best{plain_sum, 0.0};
    std::vector<std::byte> best_blocks;
    constexpr int kMostPasses = 7;
    for (int pass = 0; pass < kMostPasses && !search.is_done(); ++pass) {
        RdoResult result = rdo_pass(band, search.lambda(), literals);
        literals = result.literals;
        const Angles angles = measure(band, result.blocks, plain);
        if (!search.add(angles.sum - plain_sum)) continue;
        best = angles;
        best_blocks = std::move(result.blocks);
    }
    // The rate is an estimate: where copies are dear, what it saves may be less than nothing.
    if (!best_blocks.empty() && zstd_size(best_blocks) < zstd_size(band.plain)) {
        std::copy(best_blocks.begin(), best_blocks.end(), blocks);
    } else {
        best = {plain_sum, 0.0};
    }
    if (tally == nullptr) return;
    tally->add({static_cast<std::int64_t>(texels), std::llround(kMillionths * plain_sum),
                std::llround(kMillionths * best.sum), (best.sum - plain_sum) / texels, best.most_raised});
}

}  // namespace tex
