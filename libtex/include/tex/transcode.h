// SPDX-License-Identifier: Apache-2.0
// transcode.h: what GPUs show of files of Basis Universal.

#pragma once

#include <tex/format.h>
#include <tex/types.h>

namespace tex::inline v1 {

// -- transcode -----------------------------------------------------------------------------------------------------

// What loaders make of blocks of Basis Universal, by what a GPU can read: its transcoder makes ASTC and BC7 of the
// endpoints and indices of UASTC, and BC1 and ETC1 (which ETC2 contains) by the hints that the encoder has left in each
// block.
enum class GpuFormat { astc, bc7, etc1, bc1 };

inline constexpr Named<GpuFormat> kGpuFormatNames[] = {
    {GpuFormat::astc, "astc", "ASTC 4x4: phones and Apple's processors"},
    {GpuFormat::bc7, "bc7", "BC7: desktops"},
    {GpuFormat::etc1, "etc1", "ETC1, or ETC2 without alpha: old phones"},
    {GpuFormat::bc1, "bc1", "BC1: old desktops"},
};

// What a GPU shows of a texture of UASTC, after this transcoding: a texture of the same levels and layout in bc7_unorm
// or bc1_unorm; in rgba16_unorm, which holds what ASTC decodes to; or in rgb8_unorm, which holds what ETC1 does. ETC1S
// is a part of ETC1, and shown as that alone. The blocks are those of Basis Universal's transcoder without its slower
// options, as three.js, Babylon.js and others call it. BC1 and ETC1 have no alpha: where x or y is in it, none is
// shown.
//
// Errors: bad_option for other textures, and for layouts that the format does not hold; out_of_memory, cancelled.
[[nodiscard]] TEX_API Result<Texture> transcode(const Texture& texture, GpuFormat format,
                                                const Execution& execution = {});

}  // namespace tex::inline v1
