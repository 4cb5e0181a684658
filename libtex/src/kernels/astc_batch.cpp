// SPDX-License-Identifier: Apache-2.0

#include "kernels/astc_batch.h"

#include <algorithm>

#include "blocks/astc_ise.h"
#include "blocks/astc_void.h"
#include "kernels/astc_parts.h"

namespace tex::inline v1 {
namespace {

std::size_t place(int n) { return static_cast<std::size_t>(n); }

}  // namespace

AstcBatch::AstcBatch(const AstcGuide& guide, const AstcEffort& effort, int most)
    : guide_(guide), effort_(effort), plans_(*guide.plans), lanes_(astc_lanes()),
      texels_(plans_.block.width * plans_.block.height), values_(place(2 * (most + lanes_) * texels_)) {
    found_.reserve(place(most));
    range_.reserve(place(most));
    candidates_.reserve(place(most * effort.most_candidates()));
    some_.reserve(candidates_.capacity());
    ends_.reserve(plans_.plans.size() + 1);
}

std::size_t AstcBatch::bytes_a_block(const AstcEffort& effort) {
    return sizeof(Found) + sizeof(float) + 2 * place(effort.most_candidates()) * sizeof(Candidate);
}

AstcGroup AstcBatch::group(int first) { return {{values(first, 0), values(first, 1)}, nullptr, nullptr, nullptr}; }

// Adds a candidate with the ends that its narrow partitions ask for.
void AstcBatch::add(int block, int number, int pattern, unsigned bits) {
    const AstcPlan& plan = plans_.plans[place(number)];
    const unsigned narrow = bits & 15, turns = bits >> 4;
    const bool all = narrow == (1u << plan.partitions) - 1;
    const int mixed = all ? number : plan.mixed;
    const bool has_offsets =
        plan.channels == 2 && narrow != 0 && mixed >= 0 && kAstcRangeTable[plan.color_range].levels < 256;
    if (has_offsets) candidates_.push_back({block, mixed, pattern, 0.0f, narrow, turns});
    if (!has_offsets || effort_.both_ends) candidates_.push_back({block, number, pattern, 0.0f, 0, turns});
}

// The guesses of a lane, up to an error, become candidates of a block.
void AstcBatch::add_guesses(int block, int lane, float most, const unsigned* bits) {
    for (int q = 0; q < guesses_.count; ++q) {
        const std::size_t k = place(q * lanes_ + lane);
        if (guesses_.error[k] >= most) continue;
        add(block, static_cast<int>(guesses_.plan[k]), static_cast<int>(guesses_.pattern[k]),
            bits != nullptr ? *bits : static_cast<unsigned>(guesses_.bits[k]));
    }
}

void AstcBatch::guess() {
    const int count = static_cast<int>(found_.size());
    for (int first = 0; first < count; first += lanes_) {
        guesses_.count = effort_.guesses;
        guess_astc(guide_, group(first), guesses_);
        for (int l = 0; l < std::min(lanes_, count - first); ++l) {
            range_[place(first + l)] = guesses_.range[l];
            // A little more than nothing, for guesses of 0.
            const float most = std::min(kAstcNone, effort_.likely * (guesses_.error[l] + 1.0f));
            if (guesses_.range[l] <= 0.0f) continue;
            const unsigned narrow = guesses_.widest[l] <= kAstcNarrow ? 1 : 0;
            add_guesses(first + l, l, most, &narrow);
        }
    }
}

// Guesses several partitions for blocks whose error is greater than `worth`.
void AstcBatch::guess_parts(int partitions, float worth) {
    some_.clear();
    for (int block = 0; block < static_cast<int>(found_.size()); ++block) {
        if (found_[place(block)].error > worth && found_[place(block)].error < kAstcNone)
            some_.push_back({block, 0, 0});
    }
    for (std::size_t at = 0; at < some_.size(); at += place(lanes_)) {
        const int used = std::min(lanes_, static_cast<int>(some_.size() - at));
        gather(&some_[at], used);
        guess_astc_patterns(guide_, {{gathered_[0], gathered_[1]}, nullptr, nullptr, nullptr}, partitions,
                            effort_.patterns[partitions - 2], effort_.part_plans[partitions - 2], guesses_);
        for (int l = 0; l < used; ++l) {
            const int block = some_[at + place(l)].block;
            add_guesses(block, l, found_[place(block)].error, nullptr);
        }
    }
}

// Puts the blocks of candidates side by side; the last one fills what is left.
void AstcBatch::gather(const Candidate* candidates, int used) {
    for (int c = 0; c < 2; ++c) {
        const float* from[kAstcLanes];
        for (int l = 0; l < lanes_; ++l) from[l] = values(candidates[std::min(l, used - 1)].block, c);
        for (int k = 0; k < texels_ * lanes_; k += lanes_) {
            for (int l = 0; l < lanes_; ++l) gathered_[c][k + l] = from[l][k];
        }
    }
}

void AstcBatch::fit_some(const AstcSteps& steps, Candidate* candidates, int used) {
    gather(candidates, used);
    const AstcPlan& plan = plans_.plans[place(candidates->plan)];
    for (int l = 0; l < lanes_ && plan.partitions > 1; ++l) {
        const auto& later = pattern_of(candidates[std::min(l, used - 1)]).later;
        for (int k = 0; k < texels_; ++k)
            gathered_[2][k * lanes_ + l] = static_cast<float>((later[0] >> k & 1) + 2 * (later[1] >> k & 1));
    }
    for (int p = 0; p < plan.partitions; ++p) {
        for (int l = 0; l < lanes_; ++l)
            offsets_[p * lanes_ + l] = static_cast<float>(candidates[std::min(l, used - 1)].offsets >> p & 1);
        for (int l = 0; l < lanes_; ++l)
            turns_[p * lanes_ + l] = static_cast<float>(candidates[std::min(l, used - 1)].turns >> p & 1);
    }
    fit_astc(plan, steps, {{gathered_[0], gathered_[1]}, gathered_[2], offsets_, turns_}, fits_);
    for (int l = 0; l < used; ++l) {
        Found& found = found_[place(candidates[l].block)];
        candidates[l].error = fits_.error[l];
        if (fits_.error[l] >= found.error) continue;
        found.error = fits_.error[l];
        found.plan = candidates[l].plan;
        found.content.offsets = candidates[l].offsets;
        if (plan.partitions > 1) found.content.pattern = pattern_of(candidates[l]).index;
        for (int p = 0; p < plan.mode.planes; ++p) {
            std::uint8_t* to = found.content.weights[p];
            for (int w = 0; w < plan.grid->weights; w += 4) {
                const std::uint32_t four = fits_.weights[p][w / 4 * lanes_ + l];
                for (int k = 0; k < 4; ++k) *to++ = static_cast<std::uint8_t>(four >> (8 * k));
            }
        }
        for (int p = 0; p < plan.partitions; ++p) {
            for (int n = 0; n < 2 * plan.channels; ++n)
                found.content.ends[p][n / 2][n % 2] = static_cast<std::uint8_t>(fits_.ends[p][n / 2][n % 2][l]);
        }
    }
}

// Puts the candidates from `begin` on in the order of their plans.
void AstcBatch::sort_by_plan(std::size_t begin) {
    WorkingVector<Candidate>& sorted = some_;
    ends_.assign(plans_.plans.size() + 1, 0);
    for (std::size_t k = begin; k < candidates_.size(); ++k) ++ends_[place(candidates_[k].plan) + 1];
    for (std::size_t k = 1; k < ends_.size(); ++k) ends_[k] += ends_[k - 1];
    sorted.resize(candidates_.size() - begin);
    for (std::size_t k = begin; k < candidates_.size(); ++k)
        sorted[place(ends_[place(candidates_[k].plan)]++)] = candidates_[k];
    std::copy(sorted.begin(), sorted.end(), candidates_.begin() + static_cast<std::ptrdiff_t>(begin));
}

// Fits the candidates from `begin` on, plan by plan.
void AstcBatch::fit(const AstcSteps& steps, std::size_t begin) {
    sort_by_plan(begin);
    for (std::size_t at = begin; at < candidates_.size();) {
        int used = 1;
        while (used < lanes_ && at + place(used) < candidates_.size() &&
               candidates_[at + place(used)].plan == candidates_[at].plan)
            ++used;
        fit_some(steps, &candidates_[at], used);
        at += place(used);
    }
}

// Keeps each block's candidates with the least errors.
void AstcBatch::keep_best_candidates() {
    for (std::size_t k = 0; k < candidates_.size(); ++k) candidates_[k].place = static_cast<int>(k);
    std::sort(candidates_.begin(), candidates_.end(), [](const Candidate& a, const Candidate& b) {
        if (a.block != b.block) return a.block < b.block;
        return a.error != b.error ? a.error < b.error : a.place < b.place;
    });
    int block = -1, of_block = 0;
    const auto too_many = [&](const Candidate& candidate) {
        of_block = candidate.block == block ? of_block + 1 : 0;
        block = candidate.block;
        return of_block >= effort_.polished;
    };
    std::size_t kept = 0;
    for (std::size_t k = 0; k < candidates_.size(); ++k) {
        const Candidate candidate = candidates_[k];
        if (!too_many(candidate)) candidates_[kept++] = candidate;
    }
    candidates_.erase(candidates_.begin() + static_cast<std::ptrdiff_t>(kept), candidates_.end());
}

void AstcBatch::write(int block, std::byte* bytes) {
    const Found& found = found_[place(block)];
    // A block of one colour is better only if it hardly differs.
    constexpr float kHardly = 16.0f;
    if (range_[place(block)] < kHardly) {
        int code[2] = {0, 0xffff};
        float error = 0;
        for (int c = 0; c < plans_.channels; ++c) {
            const float* const from = values(block, c);
            float sum = 0;
            for (int k = 0; k < texels_; ++k) sum += from[k * lanes_];
            code[c] = astc_void_code(sum / static_cast<float>(texels_));
            for (int k = 0; k < texels_; ++k) {
                const float off = astc_void_value(code[c]) - from[k * lanes_];
                error += off * off;
            }
        }
        if (error <= found.error) return write_astc_void(code[0], code[1], bytes);
    }
    write_astc(plans_.plans[place(found.plan)], found.content, bytes);
}

void AstcBatch::encode(int count, std::byte* blocks) {
    found_.resize(place(count));
    for (Found& found : found_) found.error = kAstcNone;  // the first candidate sets all else
    // Vectors may reach past the last block.
    for (int block = count; block % lanes_ != 0; ++block) {
        for (int k = 0; k < 2 * texels_ * lanes_; k += lanes_) values(block, 0)[k] = 0.0f;
    }
    range_.assign(place(count), 0.0f);
    candidates_.clear();
    guess();
    fit(effort_.steps, 0);
    for (int partitions = 2; partitions <= 3; ++partitions) {
        if (effort_.patterns[partitions - 2] == 0) continue;
        const std::size_t begin = candidates_.size();
        guess_parts(partitions, effort_.worth * static_cast<float>(texels_));
        fit(effort_.steps, begin);
    }
    if (effort_.polished > 0) {
        keep_best_candidates();
        fit(effort_.polish, 0);
    }
    for (int block = 0; block < count; ++block) write(block, blocks + kAstcBlockBytes * block);
}

}  // namespace tex::inline v1
