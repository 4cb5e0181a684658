// SPDX-License-Identifier: Apache-2.0
// block_gl.h: the levels of a block-compressed texture, as Mesa's software OpenGL samples them.

#pragma once

#include <vector>

#include <tex/format.h>

namespace peers {

// Uploads every level of a block-compressed texture and reads each one back through a shader: textureLod at texel
// centres with GL_NEAREST_MIPMAP_NEAREST, so that an incomplete chain samples as black, as on a GPU. Returns RGBA of
// each level, rows from the first row of the upload; an empty vector where OpenGL reported an error.
std::vector<std::vector<float>> sample_levels(tex::Format format, const std::vector<tex::Level>& levels);

}  // namespace peers
