// SPDX-License-Identifier: Apache-2.0

#include <tex/compare.h>

#include <cstddef>
#include <vector>

#include "kernels/angle.h"
#include "rows/usable.h"
#include "stream/angle_summary.h"
#include "threads/guard.h"
#include "threads/parallel.h"

namespace tex {
namespace {}  // namespace

Result<Comparison> compare(const NormalMap& a, const NormalMap& b, const Execution& execution) {
    return guarded([&]() -> Result<Comparison> {
        for (const NormalMap* map : {&a, &b}) {
            if (auto usable = check_usable(*map); !usable) return usable.error();
        }
        if (a.extent() != b.extent()) return bad_option("the maps have different extents");
        const Extent extent = a.extent();
        Comparison comparison;
        comparison.degrees = Plane<float>(extent);
        std::vector<AngleSums> rows(static_cast<std::size_t>(extent.height));
        const auto body = [&](int begin, int end) {
            for (int j = begin; j < end; ++j) {
                float* degrees = comparison.degrees.row(j);
                angle_row({a.x.row(j), a.y.row(j), a.z.row(j)}, {b.x.row(j), b.y.row(j), b.z.row(j)}, extent.width,
                          degrees);
                rows[static_cast<std::size_t>(j)] = sum_angles(degrees, extent.width);
            }
        };
        if (auto done = parallel_for(execution, extent.height, kRowsPerPiece, body); !done) return done.error();
        const auto error = summarise_angles(comparison.degrees, rows, execution);
        if (!error) return error.error();
        comparison.error = *error;
        return comparison;
    });
}

}  // namespace tex
