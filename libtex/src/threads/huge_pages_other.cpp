// SPDX-License-Identifier: Apache-2.0
#include "threads/huge_pages.h"

namespace tex::inline v1 {

void prefer_huge_pages(void*, std::size_t) noexcept {}

}  // namespace tex::inline v1
