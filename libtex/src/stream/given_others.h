// SPDX-License-Identifier: Apache-2.0
// given_others.h: data that the caller puts beside normals.

#pragma once

#include <memory>
#include <vector>

#include <tex/pipeline.h>

#include "files/input_file.h"
#include "rows/other_rows.h"
#include "stream/flow.h"
#include "stream/open_heights.h"
#include "stream/targets.h"

namespace tex::inline v1 {

[[nodiscard]] OtherPlanes planes_given(const OtherInputs& inputs);

// Whether one file can hold all these data. Errors: bad_option.
[[nodiscard]] Result<void> check_together(OtherPlanes beside);

// Whether levels that are built of an alpha of 1 may differ from 1: by the variance of normals, or by rounding.
[[nodiscard]] bool may_change_ones(const MipOptions& mip, const std::vector<FileTarget>& files);

class GivenOthers {
public:
    // Reads maps, and opens pictures. Errors: bad_option (a file cannot hold what is given; a map has another extent; a
    // value is not from 0 to 1), those of OtherData::map and of files. May throw std::bad_alloc.
    static Result<GivenOthers> read(const OtherInputs& inputs, Extent base, const std::vector<FileTarget>& files);

    [[nodiscard]] OtherPlanes planes() const { return planes_; }
    // Adds a stage that puts the data beside normals; if there are none, returns `normals`. This object must outlive
    // the flow. Pictures are read once: a second flow needs a second object.
    [[nodiscard]] const Stage& add_to(Flow& flow, const Stage& normals) const;

    // A picture whose rows are read with those of the normals.
    struct Picture {
        const OtherPlace* place;
        InputFile file;
        Heights heights;
    };

private:
    OtherPlanes planes_;
    NormalMap map_;  // maps; what is neither here nor in a picture comes with the stage of normals
    std::vector<std::unique_ptr<Picture>> pictures_;
};

}  // namespace tex::inline v1
