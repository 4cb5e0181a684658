// SPDX-License-Identifier: Apache-2.0
// given_extras.h: data that the caller puts beside normals.

#pragma once

#include <memory>
#include <vector>

#include <tex/pipeline.h>

#include "files/input_file.h"
#include "rows/extra_rows.h"
#include "stream/flow.h"
#include "stream/open_heights.h"
#include "stream/targets.h"

namespace tex::inline v1 {

[[nodiscard]] ExtraSet planes_given(const ExtraInputs& inputs);
// The extras that are the heights which are baked.
[[nodiscard]] ExtraSet heights_given(const ExtraInputs& inputs);
// Errors: bad_option if any are, or are to be their occlusion, because nothing is baked.
[[nodiscard]] Result<void> check_no_heights(const ExtraInputs& inputs);

// Whether levels that are built of an alpha of 1 may differ from 1: by the variance of normals, or by rounding.
[[nodiscard]] bool may_change_ones(const MipOptions& mip, const std::vector<FileTarget>& files);

class GivenExtras {
public:
    // Reads maps, and opens pictures. Errors: bad_option (a file cannot hold what is given; a map has another extent; a
    // value is not from 0 to 1), those of ExtraData::map and of files. May throw std::bad_alloc.
    static Result<GivenExtras> read(const ExtraInputs& inputs, Extent base, const std::vector<FileTarget>& files);

    [[nodiscard]] ExtraSet planes() const { return planes_; }
    // Adds a stage that puts the data beside normals; if there are none, returns `normals`. This object must outlive
    // the flow. Pictures are read once: a second flow needs a second object.
    [[nodiscard]] const Stage& add_to(Flow& flow, const Stage& normals) const;

    // A picture whose rows are read with those of the normals.
    struct Picture {
        Extra extra;
        InputFile file;
        Heights heights;
    };

private:
    ExtraSet planes_;
    NormalMap map_;  // maps; what is neither here nor in a picture comes with the stage of normals
    std::vector<std::unique_ptr<Picture>> pictures_;
};

}  // namespace tex::inline v1
