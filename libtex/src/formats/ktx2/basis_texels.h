// SPDX-License-Identifier: Apache-2.0
// basis_texels.h: what a KTX2 file of Basis Universal holds, according to its data format descriptor: such files have
// no VkFormat.

#pragma once

#include <cstdint>
#include <optional>

#include <tex/format.h>
#include <tex/types.h>

#include "formats/ktx2/read_descriptor.h"
#include "formats/stored_texture.h"

namespace tex::inline v1 {

struct BasisTexels {
    Format format = Format::uastc_4x4_unorm;
    Swizzle swizzle = kSwizzleXyz;
    bool swizzle_known = false;  // RGB with alpha may be any layout
};

// Errors: bad_data, unsupported, without the name of the file. A file that neither this nor a VkFormat describes cannot
// be read.
[[nodiscard]] Result<BasisTexels> basis_texels(const std::optional<Ktx2Descriptor>& descriptor,
                                               Supercompression supercompression);

// Why a file with this scheme of supercompression, or this VkFormat, cannot be read, without its name.
[[nodiscard]] Error unknown_scheme(std::uint32_t scheme);
[[nodiscard]] Error unknown_vk_format(std::uint32_t vk);

}  // namespace tex::inline v1
