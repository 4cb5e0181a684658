// SPDX-License-Identifier: Apache-2.0
// zstd_size.h: how small bytes get.

#pragma once

#include <cstddef>
#include <vector>

namespace tex::inline v1 {

// The number of bytes after zstd, by default zstd -19. Throws std::bad_alloc.
inline constexpr int kSmallestZstd = 19;
[[nodiscard]] std::size_t zstd_size(const std::vector<std::byte>& bytes, int level = kSmallestZstd);

}  // namespace tex::inline v1
