// SPDX-License-Identifier: Apache-2.0
// deal.h: deals textures to the shards of a farm, the largest first (LPT), each to the shard with the least to do.

#pragma once

#include <cstdint>
#include <vector>

namespace tex::cli {

struct DealtTexture {
    std::int64_t cost = 1;
    std::vector<std::size_t> needs;  // textures that must be made first; they form no cycle
    bool is_refused = false;         // cannot be made; only dealt with textures that need it, which fail too
};

// Returns the textures of each shard, in ascending order. What a texture needs is in the same shard, so that shards
// wait for nothing and share no folder; so a needed texture may be in several shards. The result depends on the
// arguments alone. Precondition: shards >= 1.
[[nodiscard]] std::vector<std::vector<std::size_t>> deal(const std::vector<DealtTexture>& textures, int shards);

}  // namespace tex::cli
