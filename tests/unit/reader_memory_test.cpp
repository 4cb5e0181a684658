// SPDX-License-Identifier: Apache-2.0
// One limit of memory for a reader: its own and that of its result.

#include <gtest/gtest.h>

#include "unit/tiff_maker.h"

namespace tex {

#if !defined(__SANITIZE_ADDRESS__)  // with it, processes are larger than any limit
// In an earlier version the reader could use the memory twice: as address space, and in the result.
TEST(ReaderMemory, OneBoundHoldsForBothTogether) {
    TiffMaker tiff{4000, 10'000};
    tiff.data.resize(std::size_t{4000} * 10'000);  // 38 MiB as the result; the program itself takes 20 MiB
    ReadOptions options = quick();
    options.reader_memory = std::int64_t{44} << 20;
    const Result<Image> refused = read(tiff.make(), options);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::unsupported);
    EXPECT_EQ(refused.error().reason, "needs more memory than the 44 MiB that a decoder may have");
}
#endif

}  // namespace tex
