// SPDX-License-Identifier: Apache-2.0

#include <tex/compare.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <vector>

#include "base/guard.h"
#include "base/parallel.h"
#include "kernels/angle.h"

namespace tex {
namespace {

constexpr int kRowsPerPiece = 16;

struct RowSum {
    double sum = 0.0;
    double squares = 0.0;
    float max = -1.0f;
    int max_column = 0;
};

RowSum sum_row(const float* degrees, int count) {
    RowSum row;
    for (int i = 0; i < count; ++i) {
        const double angle = degrees[i];
        row.sum += angle;
        row.squares += angle * angle;
        if (degrees[i] > row.max) {
            row.max = degrees[i];
            row.max_column = i;
        }
    }
    return row;
}

// The bits of floats that are not negative are in the order of their values: two histograms, of the upper and then of the lower halves,
// find an exact percentile without sorting.
class Ranks {
public:
    explicit Ranks(const Plane<float>& values) : values_(values), upper_(std::size_t{1} << 15) {
        for_each([&](std::uint32_t bits) { ++upper_[bits >> 16]; });
    }

    // The value of 1-based rank `rank`.
    [[nodiscard]] float at(std::int64_t rank) const {
        std::size_t bin = 0;
        while (rank > upper_[bin]) rank -= upper_[bin++];
        std::vector<std::int64_t> lower(std::size_t{1} << 16);
        for_each([&](std::uint32_t bits) {
            if (bits >> 16 == bin) ++lower[bits & 0xffff];
        });
        std::size_t rest = 0;
        while (rank > lower[rest]) rank -= lower[rest++];
        return std::bit_cast<float>(static_cast<std::uint32_t>(bin << 16 | rest));
    }

private:
    template <class Body>
    void for_each(const Body& body) const {
        for (int j = 0; j < values_.extent().height; ++j) {
            const float* row = values_.row(j);
            for (int i = 0; i < values_.extent().width; ++i) body(std::bit_cast<std::uint32_t>(row[i]));
        }
    }

    const Plane<float>& values_;
    std::vector<std::int64_t> upper_;
};

// ceil(count * thousandths / 1000), in whole numbers.
std::int64_t rank_of(std::int64_t count, int thousandths) { return (count * thousandths + 999) / 1000; }

AngularError summarise(const Plane<float>& degrees, const std::vector<RowSum>& rows) {
    AngularError error;
    error.texels = degrees.extent().texels();
    double sum = 0.0;
    double squares = 0.0;
    float max = -1.0f;
    for (std::size_t j = 0; j < rows.size(); ++j) {
        sum += rows[j].sum;
        squares += rows[j].squares;
        if (rows[j].max > max) {
            max = rows[j].max;
            error.max_column = rows[j].max_column;
            error.max_row = static_cast<int>(j);
        }
    }
    const auto count = static_cast<double>(error.texels);
    error.mean = sum / count;
    error.rms = std::sqrt(squares / count);
    error.max = max;
    const Ranks ranks(degrees);
    error.p50 = ranks.at(rank_of(error.texels, 500));
    error.p99 = ranks.at(rank_of(error.texels, 990));
    error.p999 = ranks.at(rank_of(error.texels, 999));
    return error;
}

}  // namespace

Result<Comparison> compare(const NormalMap& a, const NormalMap& b, const Execution& execution) {
    assert(a.extent() == b.extent() && a.extent().width > 0 && a.extent().height > 0);
    return guarded([&]() -> Result<Comparison> {
        const Extent extent = a.extent();
        Comparison comparison;
        comparison.degrees = Plane<float>(extent);
        std::vector<RowSum> rows(static_cast<std::size_t>(extent.height));
        const auto body = [&](int begin, int end) {
            for (int j = begin; j < end; ++j) {
                float* degrees = comparison.degrees.row(j);
                angle_row({a.x.row(j), a.y.row(j), a.z.row(j)}, {b.x.row(j), b.y.row(j), b.z.row(j)},
                          extent.width, degrees);
                rows[static_cast<std::size_t>(j)] = sum_row(degrees, extent.width);
            }
        };
        if (auto done = parallel_for(execution, extent.height, kRowsPerPiece, body); !done) return done.error();
        comparison.error = summarise(comparison.degrees, rows);
        return comparison;
    });
}

}  // namespace tex
