// SPDX-License-Identifier: Apache-2.0
// exr_dwa.h: whether a chunk of DWAA or DWAB holds all its texels.
//
// A chunk has its own rules, which assign its channels to three buffers: cosine terms (DC and AC apart), runs, and the
// rest. OpenEXR 3.1 does not check that the buffers are full; it decodes the previous contents of the memory.

#pragma once

#include <cstddef>
#include <span>

#include <ImfChannelList.h>

namespace tex {

// Precondition: OpenEXR has decoded the chunk, of `width` x `height` texels, without an error, and the chunk is not
// stored uncompressed. May throw std::bad_alloc.
[[nodiscard]] bool dwa_is_whole(std::span<const std::byte> chunk, int width, int height,
                                const Imf::ChannelList& channels);

}  // namespace tex
