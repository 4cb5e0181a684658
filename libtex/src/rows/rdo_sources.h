// SPDX-License-Identifier: Apache-2.0
// rdo_sources.h: which earlier halves in the window a block should copy, by estimates.
//
// All earlier halves are scored by the squared error of a fit, in closed form (kernels/copy_search.h). A component's
// error counts as an angle that grows with the slope of the normals. What costs more than the literals is no source.

#pragma once

#include <cstddef>
#include <vector>

#include "kernels/copy_search.h"
#include "rows/rdo_halves.h"

namespace tex::inline v1 {

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
    float literal_bits[2];   // of x and y as they are without optimisation
};

class RdoSources {
public:
    static constexpr int kMostPairs = 3;

    // `window` is in bytes, `most` the number of blocks of the band. Throws std::bad_alloc.
    RdoSources(const HalfKind kinds[2], int window, std::size_t most);

    void set_lambda(float lambda);

    [[nodiscard]] HalfKind kind(int half) const { return halves_[static_cast<std::size_t>(half % 2)].kind(); }
    [[nodiscard]] const HalfShape& shape(int half) const {
        return halves_[static_cast<std::size_t>(half % 2)][static_cast<std::size_t>(half / 2)].shape;
    }
    // The next half of the band.
    void add(int half, const std::byte* bytes) { halves_[static_cast<std::size_t>(half % 2)].add(bytes); }
    // Finds the cheapest sources of a block: those of x, of y, and those of x from whose distance y copies too.
    void find(const RdoSearcher& block);
    [[nodiscard]] const std::vector<RdoSource>& of(int channel) const { return sources_[channel]; }
    [[nodiscard]] const std::vector<RdoSource>& pairs() const { return pairs_; }

private:
    float lambda_ = 0.0f;
    const int reach_;  // blocks
    std::vector<RdoHalves> halves_;
    std::vector<float> prices_;  // of matches in the window, the farthest first
    std::vector<RdoSource> sources_[2];
    std::vector<RdoSource> pairs_;
};

}  // namespace tex::inline v1
