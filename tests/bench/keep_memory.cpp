// SPDX-License-Identifier: Apache-2.0
// Memory that was freed is kept for the next iteration. Otherwise a benchmark of whole images measures page
// faults: the system takes longer to clear a fresh page than a kernel to fill it.

#include <limits>

#include <malloc.h>

namespace {

[[maybe_unused]] const bool kept =
    mallopt(M_MMAP_MAX, 0) != 0 && mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max()) != 0;

}  // namespace
