// SPDX-License-Identifier: Apache-2.0
// software_gl.h: a texture sampled by an OpenGL driver that nobody here wrote (Mesa's llvmpipe, off screen).

#pragma once

#include <cstddef>
#include <vector>

#include <tex/format.h>

namespace peers {

struct GlLevel {
    tex::Extent extent;
    std::vector<std::byte> bytes;
};

// RGBA of one level, rows from the first row of the upload.
struct GlTexels {
    tex::Extent extent;
    std::vector<float> rgba;
};

// True where Mesa gave a context (once for the process).
bool software_gl_works();

// Uploads every level of a block-compressed texture and reads each one back through a shader: textureLod at texel centres with
// GL_NEAREST_MIPMAP_NEAREST, so that an incomplete chain samples as black, as on a GPU. Returns an empty vector
// where OpenGL reported an error.
std::vector<GlTexels> sample_levels(tex::Format format, const std::vector<GlLevel>& levels);

}  // namespace peers
