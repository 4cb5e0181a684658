// SPDX-License-Identifier: Apache-2.0
// png_chunk.h: writes the chunks of a PNG.

#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace tex::inline v1 {

// Appends the low `bytes` bytes of a number, the highest first.
void put_png_number(std::vector<std::byte>& to, std::uint32_t value, int bytes);

// Appends the length and the type of a chunk. Its content is what is appended before end_png_chunk(), which takes the
// returned value, fills in the length and appends the CRC. Precondition: less than 2^31 bytes of content.
[[nodiscard]] std::size_t begin_png_chunk(std::vector<std::byte>& to, std::string_view type);
void end_png_chunk(std::vector<std::byte>& to, std::size_t begun);

}  // namespace tex::inline v1
