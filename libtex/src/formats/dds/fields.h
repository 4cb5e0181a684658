// SPDX-License-Identifier: Apache-2.0
// fields.h: texels whose channels are bit fields of a little-endian number, as masks describe them.

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include <tex/format.h>

namespace tex {

// A texel of `texel_bytes` (1 to 4) bytes; fields[c] is the mask of channel R, G, B, A, or 0 where the texel does
// not hold it.
struct FieldLayout {
    int texel_bytes = 4;
    std::array<std::uint32_t, 4> fields = {};
    bool snorm = false;
};

// The smallest format that holds the fields: 8 bits where every field has 1, 2, 4 or 8 bits (their values are
// exact in 8 bits), else 16; up to the last channel that there is. nullopt where a mask is not one run of bits,
// reaches beyond the texel or is wider than 16 bits, where signed fields are not all of 8 or all of 16 bits, or where
// there is no field at all.
[[nodiscard]] std::optional<Format> format_of(const FieldLayout& layout);

// Converts `texels` texels to `format`, which is format_of(layout). Absent colours are 0, absent alpha is 1.
void convert_fields(const FieldLayout& layout, const std::byte* source, std::size_t texels, Format format,
                    std::byte* target);

}  // namespace tex
