// SPDX-License-Identifier: Apache-2.0

#include "rows/rdo_sources.h"

#include <algorithm>
#include <cmath>

#include "rows/rdo_rate.h"

namespace tex::inline v1 {

RdoSources::RdoSources(const HalfKind kinds[2], int window, std::size_t most) : reach_(std::max(1, window / 16)) {
    for (int h = 0; h < 2; ++h) halves_.emplace_back(kinds[h], most);
    const auto farthest = static_cast<std::size_t>(std::min(reach_, static_cast<int>(most)));
    prices_.resize(farthest);
}

void RdoSources::set_lambda(float lambda) {
    lambda_ = lambda;
    const std::size_t farthest = prices_.size();
    for (std::size_t k = 0; k < farthest; ++k) prices_[k] = lambda * match_bits(static_cast<int>(16 * (farthest - k)));
}

void RdoSources::find(const RdoSearcher& block) {
    // Estimates err: so what seems to cost a little more than the literals is still tried.
    constexpr float kOverLiterals = 1.3f;
    const int first = std::max(0, block.number - reach_);
    const int count = block.number - first;
    const CopyTable tables[2] = {halves_[0].from(static_cast<std::size_t>(first)),
                                 halves_[1].from(static_cast<std::size_t>(first))};
    const CopyValues values[2] = {copy_values(block.values[0]), copy_values(block.values[1])};
    CopySearch search{{&tables[0], &tables[1]},
                      {&values[0], &values[1]},
                      kind(0) == kind(1),
                      keeps_slope(kind(0)),
                      count,
                      block.scale,
                      {block.rests[0], block.rests[1]},
                      prices_.data() + (prices_.size() - static_cast<std::size_t>(count)),
                      {}};
    for (const Copied copied : {Copied::indices, Copied::all_but_first, Copied::all}) {
        const int literals[2] = {literals_before(kind(0), copied), literals_before(kind(1), copied)};
        const float usual = lambda_ * kUsualLiteral;
        for (int to = 0; to < 2; ++to)
            search.extra[to][static_cast<int>(copied)] = usual * static_cast<float>(literals[to]);
        search.extra[2][static_cast<int>(copied)] = usual * static_cast<float>(literals[0] + literals[1]);
    }
    const float length = block.scale * std::sqrt(block.rests[0] + block.rests[1]);
    FoundCopies found;
    for (int to = 0; to < 2; ++to) {
        const CheapCopies none(kOverLiterals * (length + lambda_ * block.literal_bits[to]));
        for (CheapCopies& copies : found.of[to]) copies = none;
    }
    found.pairs =
        CheapCopies(kOverLiterals * (length + lambda_ * (block.literal_bits[0] + block.literal_bits[1])), kMostPairs);
    find_copies(search, found);
    for (int to = 0; to < 2; ++to) {
        sources_[to].clear();
        for (int from = 0; from < 2; ++from) {
            for (const CheapCopy& copy : found.of[to][from])
                sources_[to].push_back({2 * (first + copy.at) + from, Copied{copy.copied}});
        }
    }
    pairs_.clear();
    for (const CheapCopy& copy : found.pairs) pairs_.push_back({2 * (first + copy.at), Copied{copy.copied}});
}

}  // namespace tex::inline v1
