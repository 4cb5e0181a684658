// SPDX-License-Identifier: Apache-2.0
// exr_dwa.h: whether a chunk of DWAA or DWAB holds all its texels.
//
// A chunk sorts its channels by rules of its own into three buffers: cosine terms (DC and AC apart), runs, and the
// rest. OpenEXR 3.1 does not ask whether the buffers are full, and decodes from what was in memory before.

#pragma once

#include <cstddef>
#include <span>

#include <ImfChannelList.h>

namespace tex {

// Precondition: OpenEXR has decoded the chunk, of `width` x `height` texels, without complaint, and it is not stored as
// it is. May throw std::bad_alloc.
[[nodiscard]] bool dwa_is_whole(std::span<const std::byte> chunk, int width, int height,
                                const Imf::ChannelList& channels);

}  // namespace tex
