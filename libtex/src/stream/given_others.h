// SPDX-License-Identifier: Apache-2.0
// given_others.h: data that the caller puts beside normals.

#pragma once

#include <vector>

#include <tex/pipeline.h>

#include "stream/flow.h"
#include "stream/targets.h"

namespace tex {

[[nodiscard]] OtherPlanes planes_given(const OtherInputs& inputs);

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
    Plane<float> blue_, alpha_;  // empty: the stage of normals has them
};

}  // namespace tex
