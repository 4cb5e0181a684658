// SPDX-License-Identifier: Apache-2.0
// rdo_rows.h: rate-distortion optimisation of rows of blocks, band by band, and the promise that it keeps.

#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <vector>

#include <tex/pack.h>

#include "kernels/encode.h"
#include "rows/rdo_parts.h"

namespace tex::inline v1 {

// Collects what bands report, from several threads at once. The report does not depend on their order.
class RdoTally {
public:
    // Sums of angles in millionths of a degree.
    struct Band {
        std::int64_t texels, plain, optimised;
        double most_growth, most_raised;
    };
    void add(const Band& band);
    // The plain blocks are written after all.
    void take_plain();
    [[nodiscard]] Band sum() const;

private:
    mutable std::mutex mutex_;
    Band sum_{};
};

[[nodiscard]] RdoReport report_of(const RdoTally::Band& sum);

// The tallies of all levels.
class RdoTallies {
public:
    explicit RdoTallies(int levels) : levels_(static_cast<std::size_t>(levels)) {}

    [[nodiscard]] RdoTally& of(int level) { return levels_[static_cast<std::size_t>(level)]; }
    [[nodiscard]] RdoReport report() const;

private:
    std::vector<RdoTally> levels_;
};

// Whether blocks of this encoding are optimised with these options.
[[nodiscard]] bool is_optimised(const PackOptions& options);

// The number of rows of texels in a band (see RdoOptions), for a base level of this width. kBlockEdge if blocks are not
// optimised.
[[nodiscard]] int rdo_band_rows(const PackOptions& options, int base_width);

// Optimises the `count` rows of blocks of a band, which hold what encode_blocks() has written, one after the other. The
// band begins at row `first` of this level. Precondition: is_optimised(options), and x and y have a half each. Throws
// std::bad_alloc.
void optimise_band(const std::function<BlockRow(int row)>& rows, int count, Extent level, int first,
                   const PackOptions& options, std::byte* blocks, RdoTally* tally);

// ASTC: of what encode_astc() has written for `height` rows of texels.
void optimise_astc_band(const float* xy, int height, Extent level, int first, const PackOptions& options,
                        std::byte* blocks, RdoTally* tally);

// BC7 and UASTC: of what encode_bc7() and encode_uastc() have written.
void optimise_rgb_band(const float* texels, int height, Extent level, int first, const PackOptions& options,
                       std::byte* blocks, RdoTally* tally);

}  // namespace tex::inline v1
