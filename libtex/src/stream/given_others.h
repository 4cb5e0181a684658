// SPDX-License-Identifier: Apache-2.0
// given_others.h: data that the caller puts beside normals.

#pragma once

#include <vector>

#include <tex/pipeline.h>

#include "rows/other_rows.h"
#include "stream/flow.h"
#include "stream/targets.h"

namespace tex::inline v1 {

[[nodiscard]] OtherPlanes planes_given(const OtherInputs& inputs);

// Whether one file can hold all these data. Errors: bad_option.
[[nodiscard]] Result<void> check_together(OtherPlanes beside);

// Whether levels that are built of an alpha of 1 may differ from 1: by the variance of normals, or by rounding.
[[nodiscard]] bool may_change_ones(const MipOptions& mip, const std::vector<FileTarget>& files);

class GivenOthers {
public:
    // Reads the maps. Errors: bad_option (a file cannot hold what is given; a map has another extent; a value is not
    // from 0 to 1), those of OtherData::map. May throw std::bad_alloc.
    static Result<GivenOthers> read(const OtherInputs& inputs, Extent base, const std::vector<FileTarget>& files);

    [[nodiscard]] OtherPlanes planes() const { return planes_; }
    // Adds a stage that puts the data beside normals; if there are none, returns `normals`. This object must outlive
    // the flow.
    [[nodiscard]] const Stage& add_to(Flow& flow, const Stage& normals) const;

private:
    OtherPlanes planes_;
    NormalMap map_;  // its other data; what is empty comes with the stage of normals
};

}  // namespace tex::inline v1
