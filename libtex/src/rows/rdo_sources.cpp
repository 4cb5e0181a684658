// SPDX-License-Identifier: Apache-2.0

#include "rows/rdo_sources.h"

#include <algorithm>

#include "rows/rdo_rate.h"

namespace tex {

RdoSources::RdoSources(Encoding encoding, int window, std::size_t most, float lambda)
    : lambda_(lambda), reach_(std::max(1, window / 16)) {
    for (int h = 0; h < 2; ++h) halves_.emplace_back(half_kind(encoding, h), most);
    const auto farthest = static_cast<std::size_t>(std::min(reach_, static_cast<int>(most)));
    prices_.resize(farthest + kVectorSlack);
    for (std::size_t k = 0; k < farthest; ++k) prices_[k] = lambda * match_bits(static_cast<int>(16 * (farthest - k)));
    for (auto& of_target : errors_)
        for (auto& of_source : of_target)
            for (std::vector<float>& errors : of_source) errors.resize(farthest + kVectorSlack);
}

// Scores all halves in the window as sources of both halves of a block.
void RdoSources::scan(const RdoSearcher& block) {
    first_ = std::max(0, block.number - reach_);
    count_ = block.number - first_;
    for (std::size_t to = 0; to < 2; ++to) {
        const HalfKind kind = halves_[to].kind();
        for (std::size_t from = 0; from < 2; ++from) {
            if (halves_[from].kind() != kind) continue;
            auto& errors = errors_[to][from];
            float* const out[3] = {errors[0].data(), errors[1].data(), errors[2].data()};
            copy_errors(halves_[from].from(static_cast<std::size_t>(first_)), count_, block.values[to],
                        keeps_slope(kind), out);
        }
    }
}

void RdoSources::find(const RdoSearcher& block) {
    scan(block);
    const float* const prices = prices_.data() + (static_cast<int>(prices_.size()) - kVectorSlack - count_);
    for (int to = 0; to < 2; ++to) {
        sources_[to].clear();
        for (int from = 0; from < 2; ++from) {
            if (kind(from) != kind(to)) continue;
            CheapCopies cheapest;
            for (int copied = 0; copied < 3; ++copied) {
                const auto literals = static_cast<float>(literals_before(kind(to), Copied{copied}));
                add_cheapest({errors_[to][from][copied].data(), nullptr, block.rests[to], block.scale, prices,
                              lambda_ * kUsualLiteral * literals, copied},
                             count_, cheapest);
            }
            for (const CheapCopy& copy : cheapest)
                sources_[to].push_back({2 * (first_ + copy.at) + from, Copied{copy.copied}});
        }
    }
    find_pairs(block.scale, prices);
}

void RdoSources::find_pairs(float scale, const float* prices) {
    CheapCopies cheapest;
    for (int copied = 0; copied < 3; ++copied) {
        const int literals = literals_before(kind(0), Copied{copied}) + literals_before(kind(1), Copied{copied});
        add_cheapest({errors_[0][0][copied].data(), errors_[1][1][copied].data(), 0.0f, scale, prices,
                      lambda_ * kUsualLiteral * static_cast<float>(literals), copied},
                     count_, cheapest);
    }
    pairs_.clear();
    for (const CheapCopy& copy : cheapest) pairs_.push_back({2 * (first_ + copy.at), Copied{copy.copied}});
}

}  // namespace tex
