// SPDX-License-Identifier: Apache-2.0
// peer_texture.h: the textures that the peers' decoders are shown, and how they are compared with ours.

#pragma once

#include <string>
#include <vector>

#include <tex/tex.h>

namespace peers {

// A bumpy surface with flat parts, steep parts and noise, baked, with all its levels, packed.
tex::Texture bumpy_texture(tex::Extent extent, tex::Encoding encoding);

// A name in the test's scratch folder.
std::string scratch_path(const std::string& name);

// Sizes that exercise edges: powers of two, odd, thin, smaller than a block.
inline constexpr tex::Extent kExtents[] = {{64, 64}, {128, 32}, {129, 66}, {5, 7},
                                           {1, 1},   {1, 300},  {300, 1},  {253, 253}};

// The largest difference between channel `channel` (0 to 3) of one of our decoded levels and interleaved values of a
// peer with `channels` channels a texel, rows from the top; infinity where the sizes differ.
float largest_difference(const tex::Image& ours, int channel, const std::vector<float>& theirs, int channels);

}  // namespace peers
