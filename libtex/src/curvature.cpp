// SPDX-License-Identifier: Apache-2.0
// Handles memory and threads; rows/curvature_rows.cpp computes.

#include <tex/surface.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "kernels/stored.h"
#include "rows/curvature_rows.h"
#include "rows/usable.h"
#include "threads/no_throw.h"
#include "threads/parallel.h"

namespace tex::inline v1 {
namespace {

struct RowRange {
    float least = std::numeric_limits<float>::max();
    float greatest = std::numeric_limits<float>::lowest();
    double squares = 0.0;
};

Result<Curvature> measured(const NormalMap& map, const CurvatureOptions& options, const Execution& execution) {
    const Extent extent = map.extent();
    Curvature result;
    result.values = Plane<float>(extent);
    std::vector<RowRange> ranges(static_cast<std::size_t>(extent.height));
    const auto body = [&](int begin, int end) {
        CurvatureRows rows(map, options.kind == CurvatureKind::divergence, options.wrap_x, options.wrap_y);
        for (int j = begin; j < end; ++j) {
            float* const row = result.values.row(j);
            RowRange& range = ranges[static_cast<std::size_t>(j)];
            rows.make(j, row);
            widen_range(row, extent.width, range.least, range.greatest);
            range.squares = sum_of_squares(row, extent.width);
        }
    };
    const int grain = rows_per_piece(extent);
    if (auto done = parallel_for(execution, extent.height, grain, body); !done) return done.error();
    RowRange all;
    for (const RowRange& range : ranges) {
        all.least = std::min(all.least, range.least);
        all.greatest = std::max(all.greatest, range.greatest);
        all.squares += range.squares;
    }
    result.least = all.least;
    result.greatest = all.greatest;
    result.rms = std::sqrt(all.squares / static_cast<double>(extent.texels()));
    return result;
}

}  // namespace

Result<Curvature> curvature(const NormalMap& map, const CurvatureOptions& options, const Execution& execution) {
    return no_throw(execution, [&]() -> Result<Curvature> {
        const auto usable = first_error(check_usable(map), check_known("kind", kCurvatureKindNames, options.kind),
                                        check_known("wrap_x", kWrapNames, options.wrap_x),
                                        check_known("wrap_y", kWrapNames, options.wrap_y));
        if (!usable) return usable.error();
        return measured(map, options, execution);
    });
}

}  // namespace tex::inline v1
