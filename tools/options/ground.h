// SPDX-License-Identifier: Apache-2.0
// ground.h: what commands say about elevation models that lie on the ground (Ground in tex/types.h).

#pragma once

#include <string>

#include <tex/height.h>

#include "tasks/job.h"

namespace tex::cli {

// "30.9 x 21.5 m a texel at 45.9 north": a texel in the middle of a picture with so many rows.
[[nodiscard]] std::string texel_text(const Ground& ground, int rows);

// How a picture was baked whose file states the size of a texel, or does so in a way that could not be used.
struct GroundUse {
    bool is_used = false;  // the slopes are those of the ground
    std::string instead;   // else the option that was used; empty if there is none
    float vertical_scale = 1.0f;
    Extent extent;         // of the picture
    bool repeats = false;  // heights repeat beyond the border, which nobody asked for
};

// Prints it, and writes it into the job's report.
void note_ground(Job& job, const HeightReport& heights, const GroundUse& use);

}  // namespace tex::cli
