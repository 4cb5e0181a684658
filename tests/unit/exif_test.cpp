// SPDX-License-Identifier: Apache-2.0

#include "formats/exif.h"

#include <string>

#include <gtest/gtest.h>

#include "unit/exif_data.h"

namespace tex {
namespace {

TEST(Exif, StatesTheOrientationInEitherOrderOfBytes) {
    for (const bool big_endian : {false, true}) {
        for (int orientation = 1; orientation <= 8; ++orientation)
            EXPECT_EQ(exif_orientation(exif_data(orientation, big_endian)), static_cast<std::uint32_t>(orientation));
    }
}

TEST(Exif, ThatIsDamagedStatesNone) {
    const std::string whole = exif_data(6, false);
    EXPECT_EQ(exif_orientation(""), 1u);
    for (std::size_t size = 0; size < 20; ++size) EXPECT_LE(exif_orientation(whole.substr(0, size)), 1u) << size;
    for (std::size_t k = 0; k < whole.size(); ++k) {
        std::string changed = whole;
        changed[k] = '\xff';
        (void)exif_orientation(changed);  // reads nothing beyond the data
    }
}

}  // namespace
}  // namespace tex
