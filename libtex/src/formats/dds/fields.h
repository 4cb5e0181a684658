// SPDX-License-Identifier: Apache-2.0
// fields.h: texels whose channels are bit fields of a little-endian number, as masks describe them.

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include <tex/format.h>

namespace tex::inline v1 {

// A texel of `texel_bytes` (1 to 4) bytes; fields[c] is the mask of channel R, G, B, A, or 0 if the texel lacks the
// channel.
struct FieldLayout {
    int texel_bytes = 4;
    std::array<std::uint32_t, 4> fields = {};
    bool snorm = false;
};

// The smallest format that holds the fields: 8 bits if every field has 1, 2, 4 or 8 bits (their values are exact in 8
// bits), otherwise 16 bits; with all channels up to the last one that is present. nullopt if there is no field, if a
// mask is not one run of bits, reaches beyond the texel or is wider than 16 bits, or if signed fields are not all of 8
// or all of 16 bits.
[[nodiscard]] std::optional<Format> format_of(const FieldLayout& layout);

// Converts `texels` texels to `format`, which is format_of(layout). Absent colours become 0, absent alpha becomes 1.
void convert_fields(const FieldLayout& layout, const std::byte* source, std::size_t texels, Format format,
                    std::byte* target);

}  // namespace tex::inline v1
