// SPDX-License-Identifier: Apache-2.0
// usual_slope.h: the slope that 99 % of a map's texels stay below, and the strength that makes it 45 degrees.

#pragma once

#include <cstdint>
#include <mutex>
#include <vector>

#include <tex/pipeline.h>

#include "files/input_file.h"
#include "kernels/normal_row.h"

namespace tex::inline v1 {

// Looks at all rows of a map of up to 2^20 texels, and at about as many texels of a larger one, in any order and from
// any thread. The result depends on neither.
class UsualSlope {
public:
    // `strength` is that of the map, and not 0: slopes are counted as they are at strength 1, so that each strength of
    // the same heights finds the same.
    explicit UsualSlope(Extent extent, float strength = 1.0f);

    [[nodiscard]] bool wants(int row) const;
    void add(const VectorRow& row);

    // The 99th percentile, rise per texel along the steepest direction, to 1 %. To be called after all rows.
    [[nodiscard]] float slope() const;
    // The strength at which it is 1, to three digits; 0 if nothing slopes.
    [[nodiscard]] float strength_for_one() const;

private:
    [[nodiscard]] float slope_at_one() const;

    const int width_;
    const float strength_;
    int stride_ = 1;
    std::mutex mutex_;
    std::vector<std::int64_t> counts_;  // of slopes, in bins of equal ratio
};

// The strength at which the usual slope of the picture's bake is 1, to three digits; 1 where all heights are equal. The
// picture is read once, and can then be read again from its start. Errors: those of bake_file() that concern the
// picture. May throw std::bad_alloc.
Result<Strength> measure_strength(InputFile& file, const BakeFileOptions& options, const Execution& execution);

// The options with BakeFileOptions::auto_strength replaced by the strength that it means.
Result<BakeFileOptions> with_measured_strength(InputFile& file, const BakeFileOptions& options,
                                               const Execution& execution);

}  // namespace tex::inline v1
