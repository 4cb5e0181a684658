// SPDX-License-Identifier: Apache-2.0

#include "rows/rdo_pass.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "blocks/half_block.h"
#include "kernels/copy_search.h"
#include "rows/rdo_halves.h"
#include "rows/rdo_rate.h"

namespace tex {
namespace {

constexpr float kDegrees = 57.29577951308232f;
constexpr float kForbidden = 1e30f;

struct Choice {
    std::byte half[kHalfBytes];
    float values[16];
    float angles = kForbidden;  // degrees, summed
    float bits = 0.0f;
    float cost = kForbidden;
    int distance = 0;  // 0: literals
    int literals = kHalfBytes;
};

// What a half may copy: half number `at` of the band, counted 2 * block + channel.
struct Source {
    int at;
    Copied copied;
};

class Pass {
public:
    Pass(const RdoBand& band, float lambda, const ByteCounts& literals);
    RdoResult run();

private:
    void scan(int block);
    void find(int block);
    void find_pairs(float scale);
    Choice choose(int half, const Choice& other, const RdoMatches& matches, const std::vector<Source>& sources);
    void consider(Choice& best, Choice& tried, int half, const Choice& other) const;
    void try_copy(Choice& best, int half, const Choice& other, const RdoMatches& matches, Source source);
    void choose_block(int block);
    void add_near(int half, const RdoMatches& matches, std::vector<Source>& sources) const;
    [[nodiscard]] Choice plain_choice(int half) const;

    [[nodiscard]] const std::byte* bytes(int half) const {
        return half == pending_ ? pending_half_ : result_.blocks.data() + std::ptrdiff_t{kHalfBytes} * half;
    }
    [[nodiscard]] const float* target(int half) const {
        const RdoBlock& block = band_.blocks[static_cast<std::size_t>(half / 2)];
        return half % 2 == 0 ? block.x : block.y;
    }

    const RdoBand& band_;
    const float lambda_;
    const std::array<float, 256> literal_bits_;
    const int reach_;  // blocks
    std::vector<RdoHalves> halves_;
    std::vector<float> prices_;           // of matches in the window, the farthest first
    std::vector<float> errors_[2][2][3];  // of x and y; copied from x or y; by what is copied
    int first_ = 0, count_ = 0;           // the blocks in the window
    std::vector<Source> sources_[2];
    std::vector<Source> pairs_;  // of x; y copies the same from the same distance
    RdoMatches matches_;
    // The x that the choice of y may copy, before it is decided.
    int pending_ = -1;
    const std::byte* pending_half_ = nullptr;
    RdoResult result_;
};

Pass::Pass(const RdoBand& band, float lambda, const ByteCounts& literals)
    : band_(band), lambda_(lambda), literal_bits_(literal_bits(literals)), reach_(std::max(1, band.window / 16)) {
    const std::size_t count = band.blocks.size();
    for (int h = 0; h < 2; ++h) halves_.emplace_back(half_kind(band.encoding, h), count);
    const auto most = static_cast<std::size_t>(std::min(reach_, static_cast<int>(count)));
    prices_.resize(most + kVectorSlack);
    for (std::size_t k = 0; k < most; ++k) prices_[k] = lambda * match_bits(static_cast<int>(16 * (most - k)));
    for (auto& of_target : errors_)
        for (auto& of_source : of_target)
            for (std::vector<float>& errors : of_source) errors.resize(most + kVectorSlack);
    result_.blocks.resize(band.plain.size());
}

// Scores all halves in the window as sources of both halves of a block.
void Pass::scan(int block) {
    first_ = std::max(0, block - reach_);
    count_ = block - first_;
    for (std::size_t to = 0; to < 2; ++to) {
        const HalfKind kind = halves_[to].kind();
        for (std::size_t from = 0; from < 2; ++from) {
            if (halves_[from].kind() != kind) continue;
            auto& errors = errors_[to][from];
            float* const out[3] = {errors[0].data(), errors[1].data(), errors[2].data()};
            copy_errors(halves_[from].from(static_cast<std::size_t>(first_)), count_,
                        target(2 * block + static_cast<int>(to)), keeps_slope(kind), out);
        }
    }
}

// The squared errors of a half without optimisation.
float squared_error(const Choice& choice, const float* target) {
    float sum = 0.0f;
    for (int k = 0; k < 16; ++k) sum += (choice.values[k] - target[k]) * (choice.values[k] - target[k]);
    return sum;
}

// Finds the cheapest sources by estimates: a component's error counts as an angle that grows with the slope of the
// normals.
void Pass::find(int block) {
    scan(block);
    const RdoBlock& texels = band_.blocks[static_cast<std::size_t>(block)];
    float steepness = 0.0f;
    for (int k = 0; k < 16; ++k) {
        const float zz = texels.z[k] * texels.z[k];
        steepness += std::sqrt(1.0f + 0.5f * (1.0f - zz) / std::max(0.05f, zz));
    }
    // The mean of 16 lengths is about 0.9 of the root of their mean square.
    const float scale = 0.9f * 4.0f * kDegrees * steepness / 16.0f;
    const float* const prices = prices_.data() + (static_cast<int>(prices_.size()) - kVectorSlack - count_);
    for (int to = 0; to < 2; ++to) {
        const int half = 2 * block + to;
        const HalfKind kind = halves_[static_cast<std::size_t>(to)].kind();
        const float rest = squared_error(plain_choice(half ^ 1), target(half ^ 1));
        std::vector<Source>& sources = sources_[to];
        sources.clear();
        for (int from = 0; from < 2; ++from) {
            if (halves_[static_cast<std::size_t>(from)].kind() != kind) continue;
            CheapCopies cheapest;
            for (int copied = 0; copied < 3; ++copied) {
                const float literals = static_cast<float>(literals_before(kind, Copied{copied}));
                add_cheapest({errors_[to][from][copied].data(), nullptr, rest, scale, prices,
                              lambda_ * kUsualLiteral * literals, copied},
                             count_, cheapest);
            }
            for (const CheapCopy& copy : cheapest)
                sources.push_back({2 * (first_ + copy.at) + from, Copied{copy.copied}});
        }
    }
    find_pairs(scale);
}

void Pass::find_pairs(float scale) {
    const float* const prices = prices_.data() + (static_cast<int>(prices_.size()) - kVectorSlack - count_);
    CheapCopies cheapest;
    for (int copied = 0; copied < 3; ++copied) {
        const int literals =
            literals_before(halves_[0].kind(), Copied{copied}) + literals_before(halves_[1].kind(), Copied{copied});
        add_cheapest({errors_[0][0][copied].data(), errors_[1][1][copied].data(), 0.0f, scale, prices,
                      lambda_ * kUsualLiteral * static_cast<float>(literals), copied},
                     count_, cheapest);
    }
    pairs_.clear();
    for (const CheapCopy& copy : cheapest) pairs_.push_back({2 * (first_ + copy.at), Copied{copy.copied}});
}

Choice Pass::plain_choice(int half) const {
    Choice choice;
    std::memcpy(choice.half, band_.plain.data() + std::ptrdiff_t{kHalfBytes} * half, kHalfBytes);
    decode_half(halves_[static_cast<std::size_t>(half % 2)].kind(), choice.half, choice.values);
    return choice;
}

// Measures `tried` beside the other half, and keeps it if it is the best.
void Pass::consider(Choice& best, Choice& tried, int half, const Choice& other) const {
    if (lambda_ * tried.bits >= best.cost) return;
    const RdoBlock& block = band_.blocks[static_cast<std::size_t>(half / 2)];
    decode_half(halves_[static_cast<std::size_t>(half % 2)].kind(), tried.half, tried.values);
    const float* const normals[3] = {block.x, block.y, block.z};
    const bool is_x = half % 2 == 0;
    float chords[16];
    block_chords(normals, is_x ? tried.values : other.values, is_x ? other.values : tried.values, chords);
    bool allowed = true;
    for (int k = 0; k < 16; ++k) {
        allowed = allowed && chords[k] <= block.most[k];
        chords[k] *= block.inside[k];
    }
    if (!allowed) return;
    for (int step = 8; step > 0; step /= 2) {
        for (int k = 0; k < step; ++k) chords[k] += chords[k + step];
    }
    tried.angles = kDegrees * chords[0];
    tried.cost = tried.angles + lambda_ * tried.bits;
    if (tried.cost < best.cost) best = tried;
}

void Pass::try_copy(Choice& best, int half, const Choice& other, const RdoMatches& matches, Source source) {
    const HalfKind kind = halves_[static_cast<std::size_t>(half % 2)].kind();
    const std::byte* const from = bytes(source.at);
    Choice tried;
    tried.distance = kHalfBytes * (half - source.at);
    tried.literals = literals_before(kind, source.copied);
    const float match = matches.bits(tried.distance, source.copied == Copied::all);
    if (source.copied == Copied::all) {
        std::memcpy(tried.half, from, kHalfBytes);
        tried.bits = match;
        consider(best, tried, half, other);
        return;
    }
    const HalfShape shape = half_shape(kind, from);
    if (!shape.is_line) return;
    const HalfLine line = fit_line(kind, shape, source.copied, target(half));
    std::byte variants[kMostVariants][kHalfBytes];
    const int count = half_variants(kind, from, source.copied, line, variants);
    for (int k = 0; k < count; ++k) {
        std::memcpy(tried.half, variants[k], kHalfBytes);
        tried.bits = match;
        for (int i = 0; i < tried.literals; ++i)
            tried.bits += literal_bits_[std::to_integer<std::size_t>(variants[k][i])];
        consider(best, tried, half, other);
    }
}

Choice Pass::choose(int half, const Choice& other, const RdoMatches& matches, const std::vector<Source>& sources) {
    Choice best;
    for (const std::vector<std::byte>* literals : {&band_.plain, &band_.improved}) {
        Choice tried;
        std::memcpy(tried.half, literals->data() + std::ptrdiff_t{kHalfBytes} * half, kHalfBytes);
        for (const std::byte byte : tried.half) tried.bits += literal_bits_[std::to_integer<std::size_t>(byte)];
        consider(best, tried, half, other);
    }
    for (const Source& source : sources) try_copy(best, half, other, matches, source);
    return best;
}

// Adds copies at the last distances.
void Pass::add_near(int half, const RdoMatches& matches, std::vector<Source>& sources) const {
    const HalfKind kind = halves_[static_cast<std::size_t>(half % 2)].kind();
    for (const int distance : matches.last()) {
        const int at = half - distance / kHalfBytes;
        if (distance % kHalfBytes != 0 || at < 0 || halves_[static_cast<std::size_t>(at % 2)].kind() != kind) continue;
        for (const Copied copied : {Copied::indices, Copied::all_but_first, Copied::all})
            sources.push_back({at, copied});
    }
}

void Pass::choose_block(int block) {
    find(block);
    const int x = 2 * block;
    const int y = x + 1;
    const Choice plain_x = plain_choice(x);
    const Choice plain_y = plain_choice(y);
    add_near(x, matches_, sources_[0]);
    // The best x beside the plain y, and the best pairs' x.
    std::vector<Choice> firsts = {choose(x, plain_y, matches_, sources_[0])};
    constexpr std::size_t kPairs = 3;
    for (std::size_t k = 0; k < std::min(kPairs, pairs_.size()); ++k) {
        Choice paired;
        try_copy(paired, x, plain_y, matches_, pairs_[k]);
        if (paired.cost < kForbidden) firsts.push_back(paired);
    }
    Choice best_x;
    Choice best_y;
    RdoMatches best_matches;
    float least = kForbidden;
    for (const Choice& first : firsts) {
        RdoMatches matches = matches_;
        matches.use(first.distance);
        pending_ = x;
        pending_half_ = first.half;
        std::vector<Source> sources = sources_[1];
        add_near(y, matches, sources);
        if (halves_[0].kind() == halves_[1].kind()) {
            for (const Copied copied : {Copied::indices, Copied::all_but_first, Copied::all})
                sources.push_back({x, copied});
        }
        const Choice second = choose(y, first, matches, sources);
        const float cost = second.cost + lambda_ * first.bits;
        if (cost >= least) continue;
        least = cost;
        best_x = first;
        best_y = second;
        best_matches = matches;
        best_matches.use(second.distance);
    }
    pending_ = -1;
    if (least >= kForbidden) {
        // The promise is about the block as a whole, so the plain one is always left.
        best_x = plain_x;
        best_y = plain_y;
        best_matches = matches_;
        best_matches.use(0);
    }
    matches_ = best_matches;
    for (const auto& [half, choice] : {std::pair(x, &best_x), std::pair(y, &best_y)}) {
        std::memcpy(result_.blocks.data() + std::ptrdiff_t{kHalfBytes} * half, choice->half, kHalfBytes);
        for (int k = 0; k < choice->literals; ++k) ++result_.literals[std::to_integer<std::size_t>(choice->half[k])];
        halves_[static_cast<std::size_t>(half % 2)].add(choice->half);
    }
}

RdoResult Pass::run() {
    for (int block = 0; block < static_cast<int>(band_.blocks.size()); ++block) choose_block(block);
    return std::move(result_);
}

}  // namespace

RdoResult rdo_pass(const RdoBand& band, float lambda, const ByteCounts& literals) {
    return Pass(band, lambda, literals).run();
}

}  // namespace tex
