// SPDX-License-Identifier: Apache-2.0

#include "rows/zstd_size.h"

#include <new>

#include <zstd.h>

namespace tex::inline v1 {

std::size_t zstd_size(const std::vector<std::byte>& bytes, int level) {
    std::vector<std::byte> packed(ZSTD_compressBound(bytes.size()));
    const std::size_t size = ZSTD_compress(packed.data(), packed.size(), bytes.data(), bytes.size(), level);
    if (ZSTD_isError(size) != 0) throw std::bad_alloc();  // the bound is met, so that only memory can be missing
    return size;
}

}  // namespace tex::inline v1
