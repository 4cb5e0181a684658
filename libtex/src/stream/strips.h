// SPDX-License-Identifier: Apache-2.0
// strips.h: collects finished rows of normals in strips that are packed as a whole.

#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include <tex/normal_map.h>

#include "blocks/extent.h"
#include "kernels/bake.h"
#include "threads/pool.h"

namespace tex {

enum class Content { normals, roughness };

// Consecutive rows of a level. They begin at row `first`, which is the first row of a row of blocks. The number of rows
// is that of a strip, or less at the end of the level.
struct Strip {
    Content content = Content::normals;
    int level = 0;  // of the file
    int first = 0;
    int height = 0;
    int filled = 0;                // number of finished rows
    NormalMap map;                 // `height` rows; roughness uses x alone
    std::vector<std::byte> bytes;  // room for the code that packs the strip
};

// The strips of all levels. Rows may come in any order, but from one thread only.
class Strips {
public:
    // A strip of the base level has about `strip_texels` texels. It consists of whole rows of blocks, `block_rows` rows
    // of texels each. The base level is level `first` of the file.
    Strips(Extent base, int levels, int strip_texels, int block_rows = kBlockEdge, int first = 0,
           Content content = Content::normals);

    // The place of row j of a level, and its owner. Roughness goes to x.
    struct Place {
        NormalRow row;
        std::shared_ptr<Strip> strip;
    };
    Place place(int level, int j);
    // Row j, which was written to its place, is finished.
    void finish(int level, int j);

    // The strips that have become complete since the last call.
    std::vector<std::shared_ptr<Strip>> take_whole();

    // The number of rows of all levels that are not finished.
    [[nodiscard]] std::int64_t missing_rows() const { return missing_; }

    [[nodiscard]] int strip_rows(int level) const { return levels_[static_cast<std::size_t>(level)].rows; }

private:
    struct Level {
        Extent extent;
        int rows = 1;  // rows of a strip
        std::map<int, std::shared_ptr<Strip>> open;
        Pool<Strip> pool;
    };
    const int block_rows_;
    const int first_;
    const Content content_;
    std::vector<Level> levels_;
    std::int64_t missing_ = 0;
    std::vector<std::shared_ptr<Strip>> whole_;
};

}  // namespace tex
