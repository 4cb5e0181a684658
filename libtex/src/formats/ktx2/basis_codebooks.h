// SPDX-License-Identifier: Apache-2.0
// basis_codebooks.h: what the levels of a KTX2 file with BasisLZ share: its supercompression global data (KTX 2.0,
// "BasisLZ Global Data").
//
//     header  a description of each image  endpoints  selectors  tables

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <tex/types.h>

#include "formats/ktx2/basis_codes.h"

namespace tex::inline v1 {

// Halves of ETC1S blocks, and the codes of numbers that choose them for each block of a slice.
struct BasisCodebooks {
    using Half = std::array<std::byte, 4>;
    std::vector<Half> endpoints;  // base colour and table
    std::vector<Half> selectors;  // modifiers of the texels
    BasisCodes prediction;        // of the endpoints of 2x2 blocks
    BasisCodes endpoint_step;
    BasisCodes selector;
    BasisCodes selector_run;
    std::uint32_t history = 0;  // selectors that are remembered
};

// One image of a level: a face of a layer. Offsets are those from the start of the level.
struct BasisImage {
    bool follows_another = false;  // it is made from the image of the layer before: a P frame of an animation
    std::uint32_t color_offset = 0, color_bytes = 0;
    std::uint32_t alpha_offset = 0, alpha_bytes = 0;
};

inline constexpr std::size_t kBasisHeaderBytes = 20;
inline constexpr std::size_t kBasisImageBytes = 20;

// Precondition: kBasisImageBytes bytes.
[[nodiscard]] BasisImage read_basis_image(const std::byte* bytes);

// Reads the codebooks from the global data. `head` is the header, `rest` is what follows the descriptions of the
// images. May throw std::bad_alloc. Errors: bad_data; unsupported (selectors of a global codebook, which Basis
// Universal gave up). They do not name the file.
[[nodiscard]] Result<BasisCodebooks> read_basis_codebooks(std::span<const std::byte> head,
                                                          std::span<const std::byte> rest);

}  // namespace tex::inline v1
