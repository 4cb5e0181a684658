// SPDX-License-Identifier: Apache-2.0
// material_roughness.h: the roughness of the material itself, for each row of a base level.

#pragma once

#include <tex/mip.h>
#include <tex/types.h>

#include "rows/roughness_rows.h"
#include "threads/parallel.h"

namespace tex::inline v1 {

class MaterialRoughness {
public:
    // Uses the same roughness everywhere.
    explicit MaterialRoughness(float value, int width);

    // Uses a roughness map, which must outlive this object. If its extent differs from that of the base level, its
    // alpha^2 is halved in extent while it is twice as large, then sampled. Errors: out_of_memory, cancelled.
    static Result<MaterialRoughness> of(const Plane<float>& map, Extent base, const MipOptions& options,
                                        const Execution& execution, ProgressSpan span = {});

    // Row j: the roughness and alpha^2. Both rows have room for whole vectors.
    void row(int j, float* roughness, float* alpha2) const;

private:
    MaterialRoughness() = default;

    int width_ = 0;
    Plane<float> everywhere_;            // one row of a constant roughness,
    const Plane<float>* map_ = nullptr;  // or a map of the right extent,
    Plane<float> alpha2_;                // or the resampled alpha^2 of another map
};

// What a roughness file keeps (RoughnessFile::kept), at `levels` levels from `first` on: those of the texture, and from
// its last one on averages. Errors: bad_data (the texture has another extent than the base level), out_of_memory,
// cancelled; those of decode().
Result<KeptChannels> kept_channels(const Texture& texture, Extent base, int first, int levels,
                                   const MipOptions& options, const Execution& execution);

}  // namespace tex::inline v1
