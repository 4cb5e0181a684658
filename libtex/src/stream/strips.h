// SPDX-License-Identifier: Apache-2.0
// strips.h: finished rows of normals, gathered into strips that are packed as one.

#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include <tex/normal_map.h>

#include "kernels/bake.h"
#include "threads/pool.h"

namespace tex {

enum class Content { normals, roughness };

// Some rows of a level, from the row `first`, where a row of blocks begins, on: as many as a strip has, or those up to
// the level's end.
struct Strip {
    Content content = Content::normals;
    int level = 0;  // of the file
    int first = 0;
    int height = 0;
    int filled = 0;                // rows that are finished
    NormalMap map;                 // `height` rows of it; roughness has x alone
    std::vector<std::byte> bytes;  // room for whoever packs it
};

// The strips of all levels. Rows come in any order; one thread alone brings them.
class Strips {
public:
    // A strip of the base level has about `strip_texels` texels, and at least a row of blocks. The base level is level
    // `first` of the file.
    Strips(Extent base, int levels, int strip_texels, int first = 0, Content content = Content::normals);

    // Where row j of a level goes, and who owns the place. Roughness goes to x.
    struct Place {
        NormalRow row;
        std::shared_ptr<Strip> strip;
    };
    Place place(int level, int j);
    // Row j, in its place, is finished.
    void finish(int level, int j);

    // The strips that have become whole since the last call.
    std::vector<std::shared_ptr<Strip>> take_whole();

    // Rows of all levels that are not finished.
    [[nodiscard]] std::int64_t missing_rows() const { return missing_; }

    [[nodiscard]] int strip_rows(int level) const { return levels_[static_cast<std::size_t>(level)].rows; }

private:
    struct Level {
        Extent extent;
        int rows = 1;  // of a strip
        std::map<int, std::shared_ptr<Strip>> open;
        Pool<Strip> pool;
    };
    const int first_;
    const Content content_;
    std::vector<Level> levels_;
    std::int64_t missing_ = 0;
    std::vector<std::shared_ptr<Strip>> whole_;
};

}  // namespace tex
