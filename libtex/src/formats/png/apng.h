// SPDX-License-Identifier: Apache-2.0
// apng.h: animated PNG (W3C PNG specification, third edition, 2025): a PNG that stores the frames after the first in
// chunks of another type.

#pragma once

#include <cstddef>
#include <vector>

#include <tex/types.h>

namespace tex::inline v1 {

// Joins PNG files of the same extent and format, as encode_png() makes them, into one animation that repeats forever
// and shows each frame for 1 / frames_per_second seconds. Programs without support for animation show the first frame.
//
// Precondition: at least one file, frames_per_second from 1 to 1000. Errors: bad_option (the files differ in extent or
// format), out_of_memory.
Result<std::vector<std::byte>> join_png_frames(const std::vector<std::vector<std::byte>>& frames,
                                               int frames_per_second);

}  // namespace tex::inline v1
