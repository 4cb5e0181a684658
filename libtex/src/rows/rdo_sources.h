// SPDX-License-Identifier: Apache-2.0
// rdo_sources.h: which earlier halves in the window a block should copy, by estimates.
//
// All earlier halves are scored by the squared error of a fit, in closed form (kernels/copy_search.h). A component's
// error counts as an angle that grows with the slope of the normals.

#pragma once

#include <cstddef>
#include <vector>

#include <tex/format.h>

#include "kernels/copy_search.h"
#include "rows/rdo_halves.h"

namespace tex {

// Half number `at` of the band, counted 2 * block + channel.
struct RdoSource {
    int at;
    Copied copied;
};

// A block that searches for sources.
struct RdoSearcher {
    int number;
    const float* values[2];  // 16 of x, 16 of y
    float rests[2];          // for x and y: the squared error of the other half as it is without optimisation
    float scale;             // from the root of the sum of both squared errors to the sum of angles, in degrees
};

class RdoSources {
public:
    // `window` is in bytes, `most` the number of blocks of the band. Throws std::bad_alloc.
    RdoSources(Encoding encoding, int window, std::size_t most);

    void set_lambda(float lambda);

    [[nodiscard]] HalfKind kind(int half) const { return halves_[static_cast<std::size_t>(half % 2)].kind(); }
    // The next half of the band.
    void add(int half, const std::byte* bytes) { halves_[static_cast<std::size_t>(half % 2)].add(bytes); }
    // Finds the cheapest sources of a block: those of x, of y, and those of x from whose distance y copies too.
    void find(const RdoSearcher& block);
    [[nodiscard]] const std::vector<RdoSource>& of(int channel) const { return sources_[channel]; }
    [[nodiscard]] const std::vector<RdoSource>& pairs() const { return pairs_; }

private:
    void scan(const RdoSearcher& block);
    void add(const CopyScores& scores, const CopyScores* more, float rest, float scale, int from,
             std::vector<RdoSource>& sources) const;

    float lambda_ = 0.0f;
    const int reach_;  // blocks
    std::vector<RdoHalves> halves_;
    std::vector<float> prices_;  // of matches in the window, the farthest first
    // Of x and y; copied from x or y.
    std::vector<float> products_[2][2], least_[2][2];
    CopyScores scores_[2][2]{};
    int first_ = 0, count_ = 0;  // the blocks in the window
    std::vector<RdoSource> sources_[2];
    std::vector<RdoSource> pairs_;
};

}  // namespace tex
