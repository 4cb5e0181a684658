// SPDX-License-Identifier: Apache-2.0
#include "threads/huge_pages.h"

#include <cstdint>

#include <sys/mman.h>

namespace tex::inline v1 {

void prefer_huge_pages(void* memory, std::size_t bytes) noexcept {
    constexpr std::uintptr_t kHugePage = std::uintptr_t{1} << 21;
    constexpr std::size_t kLeastBytes = std::size_t{4} << 20;  // smaller blocks contain hardly any whole huge page
    if (bytes < kLeastBytes) return;
    const auto address = reinterpret_cast<std::uintptr_t>(memory);
    const std::uintptr_t skipped = (kHugePage - address % kHugePage) % kHugePage;
    madvise(static_cast<char*>(memory) + skipped, (bytes - skipped) / kHugePage * kHugePage, MADV_HUGEPAGE);
}

}  // namespace tex::inline v1
