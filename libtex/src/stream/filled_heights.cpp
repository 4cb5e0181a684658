// SPDX-License-Identifier: Apache-2.0

#include "stream/filled_heights.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <utility>

#include "rows/height_bytes.h"
#include "surface/debander.h"
#include "surface/nearest.h"

namespace tex::inline v1 {
namespace {

// Rows of a plane in memory.
class PlaneRows final : public RowSource {
public:
    explicit PlaneRows(Plane<float> plane) : plane_(std::move(plane)) {
        const Extent extent = plane_.extent();
        describe(extent, {"Y"}, static_cast<std::size_t>(extent.width) * sizeof(float), SampleKind::floating, 32);
    }

    [[nodiscard]] bool is_random() const override { return true; }
    Result<void> decode(int first, int count, std::byte* rows) override {
        for (int j = first; j < first + count; ++j, rows += row_bytes()) std::memcpy(rows, plane_.row(j), row_bytes());
        return {};
    }
    void store(const std::byte* rows, int first, int end, Image& image) const override {
        for (int j = first; j < end; ++j, rows += row_bytes())
            std::memcpy(image.planes.front().row(j), rows, row_bytes());
    }

private:
    const Plane<float> plane_;
};

// The column of the first NaN of a row. Precondition: there is one.
int first_nan(const Plane<float>& heights, int j) {
    const float* const row = heights.row(j);
    const float* const end = row + heights.extent().width;
    return static_cast<int>(std::find_if(row, end, [](float h) { return std::isnan(h); }) - row);
}

}  // namespace

Result<std::unique_ptr<RowSource>> fill_heights(RowSource& rows, const std::string& input, const HeightSource& source,
                                                const HeightOptions& options, const LinearRows* linear,
                                                const Execution& execution, HeightCounts& counts, DebandReport& deband,
                                                Plane<float>* with_holes) {
    // Progress: reading takes this part, and debanding up to that one.
    const double read_to = options.deband != Deband::off ? 0.2 : 0.6;
    const double debanded_to = options.deband == Deband::off ? read_to : options.fill_invalid ? 0.8 : 1.0;
    const Extent extent = rows.extent();
    Plane<float> heights(extent);
    std::pair<int, int> first_invalid{0, 0};  // column, row
    const auto take = [&](Image& image, int first, int count) -> Result<void> {
        if (linear != nullptr) {
            if (Result<void> converted = linear->convert(image, count); !converted) return converted;
        }
        for (int k = 0; k < count; ++k) {
            const HeightCounts met = take_heights(image, source, options, k, heights.row(first + k));
            if (met.invalid > 0 && counts.invalid == 0) first_invalid = {first_nan(heights, first + k), first + k};
            counts += met;
        }
        const double done = read_to * (first + count) / extent.height;
        if (execution.progress && !execution.progress(done)) return Error{ErrorCode::cancelled, {}, "cancelled"};
        return {};
    };
    if (const Result<void> read = rows.visit(input, take); !read) return read.error();
    if (auto exchanged = exchanged_bytes(counts, source.mixture)) return exchanged->of(input);
    if (counts.invalid == extent.texels() || (counts.invalid > 0 && !options.fill_invalid))
        return invalid_heights(counts.invalid, first_invalid.first, first_invalid.second, extent, options);
    const auto smooth =
        deband_heights(heights, options.wrap_x, options.wrap_y, options.deband, execution, {read_to, debanded_to});
    if (!smooth) return smooth.error();
    deband = *smooth;
    if (with_holes != nullptr && counts.invalid == 0) {
        // Nobody changes them any more: both are the same memory.
        const auto shared = std::make_shared<Plane<float>>(std::move(heights));
        const auto rows_of = [&] {
            return Plane<float>(extent, shared->stride(), std::shared_ptr<float>(shared, shared->row(0)));
        };
        *with_holes = rows_of();
        heights = rows_of();
    } else if (with_holes != nullptr) {
        *with_holes = heights.clone();
    }
    if (counts.invalid > 0) {
        const auto filled =
            fill_from_nearest(heights.view(), options.wrap_x, options.wrap_y, execution, {debanded_to, 1.0});
        if (!filled) return filled.error();
    }
    return std::unique_ptr<RowSource>(std::make_unique<PlaneRows>(std::move(heights)));
}

}  // namespace tex::inline v1
