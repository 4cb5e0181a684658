// SPDX-License-Identifier: Apache-2.0

#include <tex/check.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "kernels/angle.h"
#include "mesh/coverage.h"
#include "rows/usable.h"
#include "stream/angle_summary.h"
#include "threads/no_throw.h"
#include "threads/parallel.h"

namespace tex::inline v1 {
namespace {

Result<void> check_pair(const NormalMap& a, const NormalMap& b) {
    for (const NormalMap* map : {&a, &b}) {
        if (auto usable = check_usable(*map); !usable) return usable;
    }
    if (a.extent() != b.extent()) return bad_option("the maps have different extents");
    return {};
}

// The angles of rows, with their sums.
class Angles {
public:
    Angles(const NormalMap& a, const NormalMap& b) : a_(a), b_(b), rows_(static_cast<std::size_t>(a.extent().height)) {
        comparison_.degrees = Plane<float>(a.extent());
    }

    [[nodiscard]] float* measure(int j) {
        float* degrees = comparison_.degrees.row(j);
        angle_row({a_.x.row(j), a_.y.row(j), a_.z.row(j)}, {b_.x.row(j), b_.y.row(j), b_.z.row(j)}, a_.extent().width,
                  degrees);
        return degrees;
    }
    void sum(int j) { rows_[static_cast<std::size_t>(j)] = sum_angles(comparison_.degrees.row(j), a_.extent().width); }
    // `left_out` texels have angles of 0 that do not count.
    [[nodiscard]] Result<Comparison> finish(std::int64_t left_out, const Execution& execution) {
        const auto error = summarise_angles(comparison_.degrees, rows_, left_out, execution);
        if (!error) return error.error();
        comparison_.error = *error;
        return std::move(comparison_);
    }

private:
    const NormalMap &a_, &b_;
    std::vector<AngleSums> rows_;
    Comparison comparison_;
};

// Measures the rows from `first` on for which there are texels, and returns how many of these triangles cover.
std::int64_t measure_strip(Angles& angles, Extent extent, int first, const std::vector<Covered>& texels) {
    std::int64_t count = 0;
    const Covered* texel = texels.data();
    const int end = std::min(extent.height, first + static_cast<int>(texels.size()) / extent.width);
    for (int j = first; j < end; ++j) {
        float* const degrees = angles.measure(j);
        for (int i = 0; i < extent.width; ++i, ++texel) {
            if (texel->inside)
                ++count;
            else
                degrees[i] = 0.0f;
        }
        angles.sum(j);
    }
    return count;
}

}  // namespace

Result<Comparison> compare(const NormalMap& a, const NormalMap& b, const Execution& execution) {
    return no_throw(execution, [&]() -> Result<Comparison> {
        if (auto usable = check_pair(a, b); !usable) return usable.error();
        Angles angles(a, b);
        const auto body = [&](int begin, int end) {
            for (int j = begin; j < end; ++j) {
                std::ignore = angles.measure(j);
                angles.sum(j);
            }
        };
        if (auto done = parallel_for(execution, a.extent().height, kRowsPerPiece, body); !done) return done.error();
        return angles.finish(0, execution);
    });
}

Result<Comparison> compare(const NormalMap& a, const NormalMap& b, const MeshPart& part, int uv_set,
                           const Execution& execution) {
    return no_throw(execution, [&]() -> Result<Comparison> {
        if (auto usable = check_pair(a, b); !usable) return usable.error();
        if (auto usable = check_part(part); !usable) return usable.error();
        if (uv_set < 0 || static_cast<std::size_t>(uv_set) >= part.uvs.size())
            return bad_option("the mesh has no UVs " + std::to_string(uv_set));
        const Extent extent = a.extent();
        const auto coverage = CoverageMap::make(part, uv_set, extent, 0);
        if (!coverage) return coverage.error();
        Angles angles(a, b);
        std::atomic<std::int64_t> all_covered{0};
        const auto body = [&](int begin, int end) {
            std::vector<Covered> texels;
            for (int strip = begin; strip < end; ++strip) {
                coverage->cover(strip, texels);
                all_covered += measure_strip(angles, extent, strip * coverage->strip_rows(), texels);
            }
        };
        if (auto done = parallel_for(execution, coverage->strips(), 1, body); !done) return done.error();
        if (all_covered == 0) return bad_option("no triangle of the mesh covers a texel");
        return angles.finish(extent.texels() - all_covered, execution);
    });
}

}  // namespace tex::inline v1
