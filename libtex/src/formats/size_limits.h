// SPDX-License-Identifier: Apache-2.0
// size_limits.h: checks what a picture's header claims before memory is allocated for it.

#pragma once

#include <cstdint>
#include <string>

#include <tex/file.h>
#include <tex/types.h>

namespace tex::inline v1 {

// Checks and returns the extent that a header claims. Errors: bad_data (a side below 1), unsupported (a side above
// kMaxExtent, more texels than max_texels), out_of_memory (more texels than memory with 32-bit addresses holds).
Result<Extent> claimed_extent(const std::string& path, std::int64_t width, std::int64_t height,
                              const ReadOptions& options);

// Errors: bad_data if `size` bytes of a file, compressed by at best `ratio` to 1, cannot hold `decoded` bytes.
Result<void> check_claim(const std::string& path, Extent extent, double decoded, std::int64_t size, double ratio);

// Deflate codes at most 258 bytes with 2 bits: 1032 to 1 (zlib's technical notes).
inline constexpr double kDeflateRatio = 1032.0;

// A picture of planes with these names. The values are unset. Throws std::bad_alloc.
Image make_image(Extent extent, std::vector<std::string> names);

// The first `channels` names of R, G, B, A; with one or two channels Y, or Y and A. Throws std::bad_alloc.
std::vector<std::string> channel_names(int channels);

}  // namespace tex::inline v1
