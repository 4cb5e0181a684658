// SPDX-License-Identifier: Apache-2.0
// huge_pages.h: asks the system for memory in larger pages.

#pragma once

#include <cstddef>

namespace tex::inline v1 {

// Asks the system to back new memory with huge pages (2 MB instead of 4 KB), as far as they lie inside of it. A map of
// 4096x4096 texels has 49,000 small pages, and taking them from the system takes longer than baking it. Small blocks
// and systems without huge pages are left alone. Nothing depends on the answer.
void prefer_huge_pages(void* memory, std::size_t bytes) noexcept;

}  // namespace tex::inline v1
