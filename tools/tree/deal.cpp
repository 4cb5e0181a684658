// SPDX-License-Identifier: Apache-2.0

#include "tree/deal.h"

#include <algorithm>
#include <numeric>
#include <set>
#include <utility>

namespace tex::cli {
namespace {

class Dealer {
public:
    Dealer(const std::vector<DealtTexture>& textures, int shards)
        : textures_(textures), hands_(static_cast<std::size_t>(shards)) {
        for (std::size_t k = 0; k < hands_.size(); ++k) loads_.emplace(0, k);
    }

    std::vector<std::vector<std::size_t>> run() {
        std::vector<bool> is_needed(textures_.size());
        for (const DealtTexture& texture : textures_) {
            if (texture.is_refused) continue;
            for (const std::size_t needed : texture.needs) is_needed[needed] = true;
        }
        std::vector<std::size_t> order(textures_.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        // A texture that others need comes with them.
        std::erase_if(order, [&](std::size_t k) { return is_needed[k] || textures_[k].is_refused; });
        std::stable_sort(order.begin(), order.end(),
                         [&](std::size_t a, std::size_t b) { return textures_[a].cost > textures_[b].cost; });
        for (const std::size_t texture : order) give(texture);
        std::vector<std::vector<std::size_t>> dealt;
        dealt.reserve(hands_.size());
        for (const Hand& hand : hands_) dealt.emplace_back(hand.textures.begin(), hand.textures.end());
        return dealt;
    }

private:
    struct Hand {
        std::int64_t load = 0;
        std::set<std::size_t> textures;
    };

    void give(std::size_t texture) {
        std::set<std::size_t> all;
        collect(texture, all);
        std::size_t best = loads_.begin()->second;
        if (all.size() > 1) {  // a shard may have some of them already
            for (std::size_t k = 0; k < hands_.size(); ++k) {
                if (load_with(k, all) < load_with(best, all)) best = k;
            }
        }
        loads_.erase({hands_[best].load, best});
        hands_[best].load = load_with(best, all);
        hands_[best].textures.insert(all.begin(), all.end());
        loads_.emplace(hands_[best].load, best);
    }

    void collect(std::size_t texture, std::set<std::size_t>& all) const {
        if (!all.insert(texture).second) return;
        for (const std::size_t needed : textures_[texture].needs) collect(needed, all);
    }

    [[nodiscard]] std::int64_t load_with(std::size_t hand, const std::set<std::size_t>& added) const {
        std::int64_t load = hands_[hand].load;
        for (const std::size_t texture : added) {
            if (!hands_[hand].textures.contains(texture)) load += textures_[texture].cost;
        }
        return load;
    }

    const std::vector<DealtTexture>& textures_;
    std::vector<Hand> hands_;
    std::set<std::pair<std::int64_t, std::size_t>> loads_;  // (load, hand)
};

}  // namespace

std::vector<std::vector<std::size_t>> deal(const std::vector<DealtTexture>& textures, int shards) {
    return Dealer(textures, shards).run();
}

}  // namespace tex::cli
