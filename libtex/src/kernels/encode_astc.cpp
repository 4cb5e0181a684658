// SPDX-License-Identifier: Apache-2.0

#include "kernels/encode_astc.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstdint>
#include <memory>
#include <mutex>

#include "blocks/astc_decode.h"
#include "blocks/astc_ise.h"
#include "blocks/extent.h"
#include "kernels/astc_guess.h"
#include "kernels/astc_parts.h"
#include "memory/lent_memory.h"

namespace tex::inline v1 {
namespace {

// More than any error.
constexpr float kNone = 1e30f;

// What an effort spends.
struct Spending {
    int guesses = 1;       // plans of one partition that a block is fitted to
    float likely = kNone;  // unless their guesses are above this times the best guess
    AstcSteps steps;
    int patterns[2] = {};  // of two, of three partitions
    int part_plans[2] = {};  // for each of them
    AstcReach reach;
    float worth = 0;   // the squared error of a texel from which several partitions are tried
    int polished = 0;  // the best of all of these are fitted again, with
    AstcSteps polish;
    bool both_ends = false;  // of narrow partitions, also tries endpoints without offsets
};

Spending spending_of(Format format, Effort effort) {
    // Many weights make up for endpoints that are not the best to begin with.
    const int insets = format == Format::astc_4x4_unorm ? 3 : 2;
    switch (effort) {
        case Effort::fast: return {1, kNone, {0, 1, 1, 1, false, 0}, {}, {}, {8, 1, false, false}, 0, 0, {}, false};
        case Effort::best:
            return {32, kNone, {3, 1, 2, 2, true, 0}, {5, 4}, {12, 4}, {8, 1, true, true}, 0, 6, {5, 2, 5, 3, true, 3}, true};
        default: return {2, 1.5f, {insets, 1, 2, 2, true, 0}, {1, 0}, {2, 0}, {8, insets == 3 ? 2 : 4, false, false}, 3.0f, 0, {}, false};
    }
}

// So many blocks are encoded together: enough that most plans are those of several blocks.
constexpr int kBatch = 2048;

// A value of 1, 65536 of a decoder's codes, in units of endpoints.
constexpr float kOne = 65536.0f / 257.0f;

// Floats that begin at a multiple of 64 bytes.
class Values {
public:
    explicit Values(std::size_t count) : room_(count + kAlign / sizeof(float)) {}
    float* data() {
        const auto at = reinterpret_cast<std::uintptr_t>(room_.data());
        return room_.data() + (kAlign - at % kAlign) % kAlign / sizeof(float);
    }

private:
    static constexpr std::size_t kAlign = 64;
    WorkingVector<float> room_;
};

struct Candidate {
    int block, plan, pattern;
    float error = 0;
    unsigned offsets = 0;  // a bit for each partition that has a base and an offset
    unsigned turns = 0;    // a bit for each partition whose line is turned
    int place = 0;  // among the others: std::sort() keeps no order
};

// The most candidates that a block has.
int most_candidates(const Spending& spending) {
    const int parts = spending.patterns[0] * spending.part_plans[0] + spending.patterns[1] * spending.part_plans[1];
    return (spending.guesses + parts) * (spending.both_ends ? 2 : 1);
}

struct Found {
    Found() {}  // not all of the content is set, which would take time
    float error = kNone;
    int plan = -1;
    AstcContent content;
};

std::size_t place(int n) { return static_cast<std::size_t>(n); }

class Batch {
public:
    Batch(const AstcGuide& guide, const Spending& spending, int most)
        : guide_(guide), spending_(spending), plans_(*guide.plans), lanes_(astc_lanes()),
          texels_(plans_.block.width * plans_.block.height), values_(place(2 * (most + lanes_) * texels_)) {
        found_.reserve(place(most));
        range_.reserve(place(most));
        some_.reserve(place(most));
        candidates_.reserve(place(most * most_candidates(spending)));
    }

    // The first texel of a channel of a block; the others follow at distances of lanes().
    float* values(int block, int channel) {
        return values_.data() + place((block / lanes_ * 2 + channel) * texels_ * lanes_ + block % lanes_);
    }
    [[nodiscard]] int lanes() const { return lanes_; }

    void encode(int count, std::byte* blocks);

private:
    void gather(const Candidate* candidates, int used);
    // Of a candidate with several partitions.
    [[nodiscard]] const AstcPattern& pattern_of(const Candidate& candidate) const {
        return guide_.patterns[plans_.plans[place(candidate.plan)].partitions - 2][place(candidate.pattern)];
    }
    AstcGroup group(int first);
    void add(int block, int number, int pattern, unsigned bits);
    void add_guesses(int block, int lane, float most, const unsigned* bits);
    void guess();
    void guess_parts(int partitions, float worth);
    void fit(const AstcSteps& steps, std::size_t begin);
    void fit_some(const AstcSteps& steps, Candidate* candidates, int used);
    void number(std::size_t begin);
    void keep_best_candidates();
    void write(int block, std::byte* bytes);

    const AstcGuide& guide_;
    const Spending& spending_;
    const AstcPlans& plans_;
    const int lanes_, texels_;
    Values values_;  // of groups of lanes_ blocks: channels, texels, blocks
    WorkingVector<Found> found_;
    WorkingVector<float> range_;
    WorkingVector<Candidate> candidates_;
    WorkingVector<Candidate> some_;
    alignas(64) float gathered_[3][kAstcMostPlanned * kAstcLanes];
    alignas(64) float offsets_[3 * kAstcLanes], turns_[3 * kAstcLanes];
    AstcFits fits_;
    AstcGuesses guesses_;
};

AstcGroup Batch::group(int first) { return {{values(first, 0), values(first, 1)}, nullptr, nullptr, nullptr}; }

// Adds a candidate with the ends that its narrow partitions ask for.
void Batch::add(int block, int number, int pattern, unsigned bits) {
    const AstcPlan& plan = plans_.plans[place(number)];
    const unsigned narrow = bits & 15, turns = bits >> 4;
    const bool all = narrow == (1u << plan.partitions) - 1;
    const int mixed = all ? number : plan.mixed;
    const bool has_offsets = narrow != 0 && mixed >= 0 && kAstcRangeTable[plan.color_range].levels < 256;
    if (has_offsets) candidates_.push_back({block, mixed, pattern, 0.0f, narrow, turns});
    if (!has_offsets || spending_.both_ends) candidates_.push_back({block, number, pattern, 0.0f, 0, turns});
}

// The guesses of a lane, up to an error, become candidates of a block.
void Batch::add_guesses(int block, int lane, float most, const unsigned* bits) {
    for (int q = 0; q < guesses_.count; ++q) {
        const std::size_t k = place(q * lanes_ + lane);
        if (guesses_.error[k] >= most) continue;
        add(block, static_cast<int>(guesses_.plan[k]), static_cast<int>(guesses_.pattern[k]),
            bits != nullptr ? *bits : static_cast<unsigned>(guesses_.bits[k]));
    }
}

void Batch::guess() {
    const int count = static_cast<int>(found_.size());
    for (int first = 0; first < count; first += lanes_) {
        guesses_.count = spending_.guesses;
        guess_astc(guide_, group(first), guesses_);
        for (int l = 0; l < std::min(lanes_, count - first); ++l) {
            range_[place(first + l)] = guesses_.range[l];
            // A little more than nothing, for guesses of 0.
            const float most = std::min(kNone, spending_.likely * (guesses_.error[l] + 1.0f));
            if (guesses_.range[l] <= 0.0f) continue;
            const unsigned narrow = guesses_.widest[l] <= kAstcNarrow ? 1 : 0;
            add_guesses(first + l, l, most, &narrow);
        }
    }
}

// Guesses several partitions for blocks whose error is greater than `worth`.
void Batch::guess_parts(int partitions, float worth) {
    some_.clear();
    for (int block = 0; block < static_cast<int>(found_.size()); ++block) {
        if (found_[place(block)].error > worth && found_[place(block)].error < kNone)
            some_.push_back({block, 0, 0});
    }
    for (std::size_t at = 0; at < some_.size(); at += place(lanes_)) {
        const int used = std::min(lanes_, static_cast<int>(some_.size() - at));
        gather(&some_[at], used);
        guess_astc_patterns(guide_, {{gathered_[0], gathered_[1]}, nullptr, nullptr, nullptr}, partitions,
                            spending_.patterns[partitions - 2], spending_.part_plans[partitions - 2], guesses_);
        for (int l = 0; l < used; ++l) {
            const int block = some_[at + place(l)].block;
            add_guesses(block, l, found_[place(block)].error, nullptr);
        }
    }
}

// Puts the blocks of candidates side by side; the last one fills what is left.
void Batch::gather(const Candidate* candidates, int used) {
    for (int c = 0; c < 2; ++c) {
        const float* from[kAstcLanes];
        for (int l = 0; l < lanes_; ++l) from[l] = values(candidates[std::min(l, used - 1)].block, c);
        for (int k = 0; k < texels_ * lanes_; k += lanes_) {
            for (int l = 0; l < lanes_; ++l) gathered_[c][k + l] = from[l][k];
        }
    }
}

void Batch::fit_some(const AstcSteps& steps, Candidate* candidates, int used) {
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
            for (int w = 0; w < plan.grid->weights; ++w)
                found.content.weights[p][w] = static_cast<std::uint8_t>(fits_.weights[p][w * lanes_ + l]);
        }
        for (int n = 0; n < 4 * plan.partitions; ++n) {
            found.content.ends[n / 4][n / 2 % 2][n % 2] =
                static_cast<std::uint8_t>(fits_.ends[n / 4][n / 2 % 2][n % 2][l]);
        }
    }
}

// Candidates from `begin` on know their places.
void Batch::number(std::size_t begin) {
    for (std::size_t k = begin; k < candidates_.size(); ++k) candidates_[k].place = static_cast<int>(k);
}

// Fits the candidates from `begin` on, plan by plan.
void Batch::fit(const AstcSteps& steps, std::size_t begin) {
    const auto first = candidates_.begin() + static_cast<std::ptrdiff_t>(begin);
    number(begin);
    std::sort(first, candidates_.end(), [](const Candidate& a, const Candidate& b) {
        return a.plan != b.plan ? a.plan < b.plan : a.place < b.place;
    });
    for (std::size_t at = begin; at < candidates_.size();) {
        int used = 1;
        while (used < lanes_ && at + place(used) < candidates_.size() &&
               candidates_[at + place(used)].plan == candidates_[at].plan)
            ++used;
        fit_some(steps, &candidates_[at], used);
        at += place(used);
    }
}

// Of each block, those with the least errors.
void Batch::keep_best_candidates() {
    number(0);
    std::sort(candidates_.begin(), candidates_.end(), [](const Candidate& a, const Candidate& b) {
        if (a.block != b.block) return a.block < b.block;
        return a.error != b.error ? a.error < b.error : a.place < b.place;
    });
    int block = -1, of_block = 0;
    const auto too_many = [&](const Candidate& candidate) {
        of_block = candidate.block == block ? of_block + 1 : 0;
        block = candidate.block;
        return of_block >= spending_.polished;
    };
    std::size_t kept = 0;
    for (std::size_t k = 0; k < candidates_.size(); ++k) {
        const Candidate candidate = candidates_[k];
        if (!too_many(candidate)) candidates_[kept++] = candidate;
    }
    candidates_.erase(candidates_.begin() + static_cast<std::ptrdiff_t>(kept), candidates_.end());
}

// What a decoder makes of a code of 16 bits, in units of endpoints.
float decoded(int code) { return astc_value(code) * kOne; }

// The code of which it makes the value that is nearest. A decoder keeps 11 bits of a code, so that codes which differ
// in the others are one value: that of `code`, the one before and the one after are what the nearest can be.
int void_code(float value) {
    const auto code = static_cast<int>(std::clamp(value * 257.0f, 0.0f, 65535.0f));
    // How many codes are one value.
    const auto step_of = [](int of) {
        return 1 << std::max(0, static_cast<int>(std::bit_width(static_cast<unsigned>(of))) - 11);
    };
    const auto first_like = [&](int of) { return of & ~(step_of(of) - 1); };
    const int first = first_like(code);
    int best = code;
    const auto take_nearer = [&](int other) {
        if (std::abs(decoded(other) - value) < std::abs(decoded(best) - value)) best = other;
    };
    if (first > 0) take_nearer(std::max(code - 32, first_like(first - 1)));
    const int after = first + step_of(code);
    if (after <= 0xffff) take_nearer(after);
    if (code < 0xffff && code + 32 >= 0xffff) take_nearer(0xffff);
    return best;
}

void Batch::write(int block, std::byte* bytes) {
    const Found& found = found_[place(block)];
    // A block of one colour is better only if it hardly differs.
    constexpr float kHardly = 16.0f;
    if (range_[place(block)] < kHardly) {
        int code[2];
        float error = 0;
        for (int c = 0; c < 2; ++c) {
            const float* const from = values(block, c);
            float sum = 0;
            for (int k = 0; k < texels_; ++k) sum += from[k * lanes_];
            code[c] = void_code(sum / static_cast<float>(texels_));
            for (int k = 0; k < texels_; ++k) {
                const float off = decoded(code[c]) - from[k * lanes_];
                error += off * off;
            }
        }
        if (error <= found.error) return write_astc_void(code[0], code[1], bytes);
    }
    write_astc(plans_.plans[place(found.plan)], found.content, bytes);
}

void Batch::encode(int count, std::byte* blocks) {
    found_.resize(place(count));
    for (Found& found : found_) found.error = kNone;  // the first candidate sets all else
    range_.assign(place(count), 0.0f);
    candidates_.clear();
    guess();
    fit(spending_.steps, 0);
    for (int partitions = 2; partitions <= 3; ++partitions) {
        if (spending_.patterns[partitions - 2] == 0) continue;
        const std::size_t begin = candidates_.size();
        guess_parts(partitions, spending_.worth * static_cast<float>(texels_));
        fit(spending_.steps, begin);
    }
    if (spending_.polished > 0) {
        keep_best_candidates();
        fit(spending_.polish, 0);
    }
    for (int block = 0; block < count; ++block) write(block, blocks + kAstcBlockBytes * block);
}

// The guides that were made, by size of blocks and effort.
constexpr std::size_t kGuides = 3 * 8;
std::array<std::atomic<const AstcGuide*>, kGuides> made_guides;

std::size_t guide_number(Format format, Effort effort) {
    const std::size_t size = static_cast<std::size_t>(format) - static_cast<std::size_t>(Format::astc_4x4_unorm);
    return 3 * size + static_cast<std::size_t>(effort);
}

const AstcGuide& guide_of(Format format, Effort effort) {
    static std::array<std::once_flag, kGuides> once;
    static std::array<std::unique_ptr<const AstcGuide>, kGuides> kept;
    const std::size_t at = guide_number(format, effort);
    if (const AstcGuide* const made = made_guides[at].load(std::memory_order_acquire)) return *made;
    std::call_once(once[at], [&] {
        const AstcPlans& plans = astc_plans(format_info(format).block);
        kept[at] = std::make_unique<const AstcGuide>(make_astc_guide(plans, spending_of(format, effort).reach));
        made_guides[at].store(kept[at].get(), std::memory_order_release);
    });
    return *kept[at];
}

}  // namespace

bool encodes_astc(Format format) { return format >= Format::astc_4x4_unorm && format <= Format::astc_8x8_unorm; }

void prepare_astc(Format format, Effort effort) { guide_of(format, effort); }

bool is_astc_prepared(Format format, Effort effort) {
    return made_guides[guide_number(format, effort)].load(std::memory_order_acquire) != nullptr;
}

int astc_rows_at_once(Format format, int width) {
    return std::max(1, kBatch / blocks_across(width, format_info(format).block.width));
}

std::size_t astc_memory(Format format, Effort effort, int width, int rows) {
    const Extent block = format_info(format).block;
    const Spending spending = spending_of(format, effort);
    const std::size_t texels = place(width) * place(rows * block.height);
    const std::size_t most = std::min(place(kBatch), place(blocks_across(width, block.width)) * place(rows));
    const std::size_t values = 2 * (most + kAstcLanes) * place(block.width * block.height) + 16;
    const std::size_t candidates = place(most_candidates(spending)) + 1;  // some_ has one for each block
    return 2 * texels * sizeof(float) + sizeof(Batch) + values * sizeof(float) +
           most * (sizeof(Found) + sizeof(float) + candidates * sizeof(Candidate)) + 16 * LentMemory::kStep;
}

void encode_astc(Format format, Effort effort, const float* xy, Extent extent, std::byte* blocks) {
    const Extent block = format_info(format).block;
    const int across = blocks_across(extent.width, block.width);
    const int all = across * blocks_across(extent.height, block.height);
    const Spending spending = spending_of(format, effort);
    const auto texels = static_cast<std::size_t>(extent.texels());
    WorkingVector<float> planes[2];
    for (WorkingVector<float>& plane : planes) plane.resize(texels);
    astc_planes(xy, texels, 0.5f * kOne, planes[0].data(), planes[1].data());
    WorkingVector<Batch> batches;  // exactly one
    batches.reserve(1);
    batches.emplace_back(guide_of(format, effort), spending, std::min(kBatch, all));
    Batch* const batch = &batches.front();
    const int lanes = batch->lanes();
    for (int first = 0; first < all; first += kBatch) {
        const int count = std::min(kBatch, all - first);
        for (int n = 0; n < count; ++n) {
            const int left = (first + n) % across * block.width, top = (first + n) / across * block.height;
            for (int c = 0; c < 2; ++c) {
                float* to = batch->values(n, c);
                const bool is_inside = left + block.width <= extent.width;
                for (int j = top; j < top + block.height; ++j) {
                    const float* const row = planes[c].data() + place(std::min(j, extent.height - 1) * extent.width);
                    if (is_inside) {
                        for (int i = 0; i < block.width; ++i) to[place(i * lanes)] = row[left + i];
                    } else {
                        for (int i = 0; i < block.width; ++i)
                            to[place(i * lanes)] = row[std::min(left + i, extent.width - 1)];
                    }
                    to += block.width * lanes;
                }
            }
        }
        batch->encode(count, blocks + kAstcBlockBytes * static_cast<std::ptrdiff_t>(first));
    }
}

}  // namespace tex::inline v1
