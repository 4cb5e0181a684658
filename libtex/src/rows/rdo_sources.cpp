// SPDX-License-Identifier: Apache-2.0

#include "rows/rdo_sources.h"

#include <algorithm>

#include "rows/rdo_rate.h"

namespace tex {

RdoSources::RdoSources(Encoding encoding, int window, std::size_t most) : reach_(std::max(1, window / 16)) {
    for (int h = 0; h < 2; ++h) halves_.emplace_back(half_kind(encoding, h), most);
    const auto farthest = static_cast<std::size_t>(std::min(reach_, static_cast<int>(most)));
    prices_.resize(farthest + kVectorSlack);
    for (std::size_t to = 0; to < 2; ++to) {
        for (std::size_t from = 0; from < 2; ++from) {
            products_[to][from].resize(farthest + kVectorSlack);
            least_[to][from].resize(farthest + kVectorSlack);
        }
    }
}

void RdoSources::set_lambda(float lambda) {
    lambda_ = lambda;
    const std::size_t farthest = prices_.size() - kVectorSlack;
    for (std::size_t k = 0; k < farthest; ++k) prices_[k] = lambda * match_bits(static_cast<int>(16 * (farthest - k)));
}

// Scores all halves in the window as sources of both halves of a block.
void RdoSources::scan(const RdoSearcher& block) {
    first_ = std::max(0, block.number - reach_);
    count_ = block.number - first_;
    for (std::size_t to = 0; to < 2; ++to) {
        const HalfKind kind = halves_[to].kind();
        for (std::size_t from = 0; from < 2; ++from) {
            if (halves_[from].kind() != kind) continue;
            scores_[to][from] =
                score_copies(halves_[from].from(static_cast<std::size_t>(first_)), count_, block.values[to],
                             keeps_slope(kind), products_[to][from].data(), least_[to][from].data());
        }
    }
}

// Adds the cheapest sources. If `more` is not null, y copies too.
void RdoSources::add(const CopyScores& scores, const CopyScores* more, float rest, float scale, int from,
                     std::vector<RdoSource>& sources) const {
    const float* const prices = prices_.data() + (static_cast<int>(prices_.size()) - kVectorSlack - count_);
    CopyCosts costs{&scores, more, rest, scale, prices, {}};
    for (const Copied copied : {Copied::indices, Copied::all_but_first, Copied::all}) {
        int literals = literals_before(kind(from), copied);
        if (more != nullptr) literals += literals_before(kind(1), copied);
        costs.extra[static_cast<int>(copied)] = lambda_ * kUsualLiteral * static_cast<float>(literals);
    }
    CheapCopies cheapest;
    add_cheapest(costs, count_, cheapest);
    for (const CheapCopy& copy : cheapest) sources.push_back({2 * (first_ + copy.at) + from, Copied{copy.copied}});
}

void RdoSources::find(const RdoSearcher& block) {
    scan(block);
    for (int to = 0; to < 2; ++to) {
        sources_[to].clear();
        for (int from = 0; from < 2; ++from) {
            if (kind(from) == kind(to))
                add(scores_[to][from], nullptr, block.rests[to], block.scale, from, sources_[to]);
        }
    }
    pairs_.clear();
    add(scores_[0][0], &scores_[1][1], 0.0f, block.scale, 0, pairs_);
}

}  // namespace tex
