// SPDX-License-Identifier: Apache-2.0

#include "stream/strips.h"

#include <algorithm>
#include <utility>

#include <tex/mip_chain.h>

namespace tex {

Strips::Strips(Extent base, int levels, int strip_texels, int block_rows, int first, Content content)
    : block_rows_(block_rows), first_(first), content_(content), levels_(static_cast<std::size_t>(levels)) {
    for (int k = 0; k < levels; ++k) {
        Level& level = levels_[static_cast<std::size_t>(k)];
        level.extent = level_extent(base, k);
        missing_ += level.extent.height;
        // The number of rows that are made during one strip of the base level, but at least one row of blocks.
        level.rows = std::max(block_rows, ((strip_texels / base.width) >> k) / block_rows * block_rows);
    }
}

Strips::Place Strips::place(int level_index, int j) {
    Level& level = levels_[static_cast<std::size_t>(level_index)];
    std::shared_ptr<Strip>& strip = level.open[j / level.rows];
    if (!strip) {
        const Extent extent{level.extent.width, std::min(level.rows, whole_blocks(level.extent.height, block_rows_))};
        strip = level.pool.take([extent, this] {
            auto made = std::make_unique<Strip>();
            made->content = content_;
            if (content_ == Content::normals)
                made->map = NormalMap(extent);
            else
                made->map.x = Plane<float>(extent);
            return made;
        });
        strip->level = first_ + level_index;
        strip->first = j / level.rows * level.rows;
        strip->height = std::min(level.rows, level.extent.height - strip->first);
        strip->filled = 0;
    }
    const int row = j - strip->first;
    if (content_ == Content::roughness) return {{strip->map.x.row(row), nullptr, nullptr}, strip};
    return {{strip->map.x.row(row), strip->map.y.row(row), strip->map.z.row(row)}, strip};
}

void Strips::finish(int level_index, int j) {
    Level& level = levels_[static_cast<std::size_t>(level_index)];
    --missing_;
    const auto at = level.open.find(j / level.rows);
    if (++at->second->filled < at->second->height) return;
    whole_.push_back(std::move(at->second));
    level.open.erase(at);
}

std::vector<std::shared_ptr<Strip>> Strips::take_whole() { return std::exchange(whole_, {}); }

}  // namespace tex
