// SPDX-License-Identifier: Apache-2.0
// unclaimed_bytes.h: what a KTX2 file holds besides what its header names.

#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <tex/types.h>

#include "formats/stored_texture.h"

namespace tex::inline v1 {

struct ClaimedBytes {
    std::uint64_t begin, count;
};

// The number of bytes of a file of `size` bytes that are in none of the ranges, which may overlap and end beyond the
// file. Padding does not count: gaps that are shorter than the longest alignment of levels, and zeros. Errors: those of
// `fetch`. May throw std::bad_alloc.
[[nodiscard]] Result<std::uint64_t> unclaimed_bytes(const FetchBytes& fetch, std::uint64_t size,
                                                    std::vector<ClaimedBytes> ranges);

}  // namespace tex::inline v1
