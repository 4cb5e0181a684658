// SPDX-License-Identifier: Apache-2.0

#include "rows/rdo_pass.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "blocks/block_half.h"
#include "kernels/chords.h"
#include "kernels/copy_search.h"
#include "rows/rdo_candidates.h"
#include "rows/rdo_rate.h"
#include "rows/rdo_sources.h"

namespace tex::inline v1 {
namespace {

constexpr float kDegreesOfChord = 57.29577951308232f;  // for short chords
constexpr Copied kAllCopied[] = {Copied::indices, Copied::all_but_first, Copied::all};

// What a half becomes.
struct Choice {
    RdoCandidate candidate;
    float values[16];
    float bits;  // with those of the match
};

class HalvesPass final : public RdoRuns {
public:
    HalvesPass(const RdoBand& band, const ByteCounts& literals);

private:
    void set_lambda(float lambda) override;
    void keep_block(int block) override;
    void choose_block(int block) override;
    void start(int block);
    void add_near(int half, int distance);
    void find_firsts(int block);
    float choose(int half, const Choice& other, const RdoMatches& matches, Choice& best);
    [[nodiscard]] Choice take(const RdoCandidates& from, int index, const RdoMatches& matches) const;
    [[nodiscard]] float match_price(const RdoCandidate& candidate, const RdoMatches& matches) const;
    void write(int half, const Choice& choice);

    [[nodiscard]] const std::byte* plain(int half) const {
        return band_.plain.data() + std::ptrdiff_t{kHalfBytes} * half;
    }
    [[nodiscard]] const std::byte* written(int half) const {
        return result_.blocks.data() + std::ptrdiff_t{kHalfBytes} * half;
    }

    const RdoBand& band_;
    float lambda_ = 0.0f;
    const std::array<float, 256> literal_bits_;
    RdoSources sources_;
    RdoCandidates candidates_[2];
    Choice plain_[2];
    std::vector<Choice> firsts_;  // what x may become
    RdoMatches matches_;
};

HalvesPass::HalvesPass(const RdoBand& band, const ByteCounts& literals)
    : RdoRuns(band), band_(band), literal_bits_(literal_bits(literals)),
      sources_(band.kinds, band.window, band.count()) {}

void HalvesPass::set_lambda(float lambda) {
    lambda_ = lambda;
    sources_.set_lambda(lambda);
}

// The root of the sum of squared errors times this is about the sum of angles, in degrees.
float angle_scale(const RdoBlock& texels) {
    float steepness = 0.0f;
    for (int k = 0; k < 16; ++k) {
        const float zz = texels.z[k] * texels.z[k];
        steepness += std::sqrt(1.0f + 0.5f * (1.0f - zz) / std::max(0.05f, zz));
    }
    // The mean of 16 lengths is about 0.9 of the root of their mean square.
    return 0.9f * 4.0f * kDegreesOfChord * steepness / 16.0f;
}

// Finds candidates for both halves that do not depend on each other.
void HalvesPass::start(int block) {
    const RdoBlock& texels = band_.blocks[static_cast<std::size_t>(block)];
    RdoSearcher searcher{block, {texels.x, texels.y}, {}, angle_scale(texels), {}};
    for (int to = 0; to < 2; ++to) {
        Choice& choice = plain_[to];
        std::memcpy(choice.candidate.half, plain(2 * block + to), kHalfBytes);
        choice.candidate.distance = 0;
        choice.candidate.literals = kHalfBytes;
        decode_half(sources_.kind(to), choice.candidate.half, choice.values);
        for (int k = 0; k < 16; ++k) {
            const float d = choice.values[k] - searcher.values[to][k];
            searcher.rests[1 - to] += d * d;
        }
        for (const std::byte byte : choice.candidate.half)
            searcher.literal_bits[to] += literal_bits_[std::to_integer<std::size_t>(byte)];
    }
    sources_.find(searcher);
    for (int to = 0; to < 2; ++to) {
        const int half = 2 * block + to;
        RdoCandidates& candidates = candidates_[to];
        candidates.start(
            {sources_.kind(to), searcher.values[to], searcher.rests[to], searcher.scale, lambda_, &literal_bits_});
        candidates.add_literals(plain(half));
        candidates.add_literals(band_.improved.data() + std::ptrdiff_t{kHalfBytes} * half);
        for (const RdoSource& source : sources_.of(to))
            candidates.add_copies(written(source.at), kHalfBytes * (half - source.at), source.copied);
        for (const int distance : matches_.last()) add_near(half, distance);
    }
}

// Adds copies at a distance that a coder writes in a few bits.
void HalvesPass::add_near(int half, int distance) {
    const int at = half - distance / kHalfBytes;
    const bool is_earlier = at >= 0 && at / 2 < half / 2;
    if (distance % kHalfBytes != 0 || !is_earlier || sources_.kind(at) != sources_.kind(half)) return;
    for (const Copied copied : kAllCopied) candidates_[half % 2].add_copies(written(at), distance, copied);
}

float HalvesPass::match_price(const RdoCandidate& candidate, const RdoMatches& matches) const {
    return candidate.distance == 0 ? 0.0f : matches.bits(candidate.distance, candidate.literals == 0);
}

Choice HalvesPass::take(const RdoCandidates& from, int index, const RdoMatches& matches) const {
    Choice choice;
    choice.candidate = from[index];
    from.copy_values(index, choice.values);
    choice.bits = from[index].bits + match_price(from[index], matches);
    return choice;
}

// Finds the best candidate beside the other half. Returns its cost: the sum of angles and the bits of this half.
// kTooLong: no candidate keeps the limits.
float HalvesPass::choose(int half, const Choice& other, const RdoMatches& matches, Choice& best) {
    const RdoBlock& texels = band_.blocks[static_cast<std::size_t>(half / 2)];
    const RdoCandidates& candidates = candidates_[half % 2];
    const bool is_x = half % 2 == 0;
    float sums[RdoCandidates::kStride];
    chord_sums(
        {is_x ? texels.x : texels.y, is_x ? texels.y : texels.x, texels.z, other.values, texels.most, texels.inside},
        candidates.values(), RdoCandidates::kStride, candidates.count(), sums);
    float least = kTooLong;
    int found = -1;
    for (int k = 0; k < candidates.count(); ++k) {
        if (sums[k] >= kTooLong) continue;
        const float bits = candidates[k].bits + match_price(candidates[k], matches);
        const float cost = kDegreesOfChord * sums[k] + lambda_ * bits;
        if (cost >= least) continue;
        least = cost;
        found = k;
    }
    if (found >= 0) best = take(candidates, found, matches);
    return least;
}

// The best x beside the plain y, and those of the best pairs.
void HalvesPass::find_firsts(int block) {
    const int x = 2 * block;
    firsts_.clear();
    Choice best;
    if (choose(x, plain_[1], matches_, best) < kTooLong) firsts_.push_back(best);
    for (const RdoSource& pair : sources_.pairs()) {
        const int count = candidates_[0].count();
        candidates_[0].add_copies(written(pair.at), kHalfBytes * (x - pair.at), pair.copied, 1);
        if (candidates_[0].count() > count) firsts_.push_back(take(candidates_[0], count, matches_));
        candidates_[0].keep(count);
    }
}

void HalvesPass::choose_block(int block) {
    start(block);
    find_firsts(block);
    const int y = 2 * block + 1;
    RdoCandidates& seconds = candidates_[1];
    const int independent = seconds.count();
    // The promise is about the block as a whole, so the plain one is always left.
    Choice best[2] = {plain_[0], plain_[1]};
    float least = kTooLong;
    for (const Choice& first : firsts_) {
        RdoMatches matches = matches_;
        const int distance = first.candidate.distance;
        matches.use(distance);
        if (std::find(matches_.last().begin(), matches_.last().end(), distance) == matches_.last().end())
            add_near(y, distance);
        if (sources_.kind(0) == sources_.kind(1)) {
            for (const Copied copied : kAllCopied) seconds.add_copies(first.candidate.half, kHalfBytes, copied);
        }
        Choice second;
        const float cost = choose(y, first, matches, second) + lambda_ * first.bits;
        seconds.keep(independent);
        if (cost >= least) continue;
        least = cost;
        best[0] = first;
        best[1] = second;
    }
    std::byte bytes[2 * kHalfBytes];
    for (int to = 0; to < 2; ++to) std::memcpy(bytes + kHalfBytes * to, best[to].candidate.half, kHalfBytes);
    const auto index = static_cast<std::size_t>(block);
    const RdoAngles angles = rdo_angles(band_, index, bytes);
    const double growth = angles.sum - band_.improved_angles[index];
    if (!spend(block, growth)) return keep_block(block);
    result_.most_raised = std::max(result_.most_raised, angles.most_raised);
    for (int to = 0; to < 2; ++to) write(2 * block + to, best[to]);
}

// Writes the improved literals.
void HalvesPass::keep_block(int block) {
    for (int half = 2 * block; half < 2 * block + 2; ++half) {
        Choice kept;
        std::memcpy(kept.candidate.half, band_.improved.data() + std::ptrdiff_t{kHalfBytes} * half, kHalfBytes);
        kept.candidate.distance = 0;
        kept.candidate.literals = kHalfBytes;
        write(half, kept);
    }
}

void HalvesPass::write(int half, const Choice& choice) {
    const RdoCandidate& candidate = choice.candidate;
    std::memcpy(result_.blocks.data() + std::ptrdiff_t{kHalfBytes} * half, candidate.half, kHalfBytes);
    for (int k = 0; k < candidate.literals; ++k) ++result_.literals[std::to_integer<std::size_t>(candidate.half[k])];
    matches_.use(candidate.distance);
    sources_.add(half, candidate.half);
}

}  // namespace

std::unique_ptr<RdoRuns> rdo_pass(const RdoBand& band, const ByteCounts& literals) {
    return std::make_unique<HalvesPass>(band, literals);
}

}  // namespace tex::inline v1
