// SPDX-License-Identifier: Apache-2.0
#include "finite.h"

#include <cstdint>
#include <cstring>

namespace tex::python {

bool is_finite(PlaneView<const float> plane) {
    constexpr std::uint32_t kInfinity = 0x7f800000U;
    for (int j = 0; j < plane.extent.height; ++j) {
        const float* const row = plane.row(j);
        std::uint32_t found = 0;  // all bits, once an exponent has all bits; every instruction set has this in vectors
        for (int i = 0; i < plane.extent.width; ++i) {
            std::uint32_t bits = 0;
            std::memcpy(&bits, row + i, sizeof bits);
            found |= (bits & kInfinity) == kInfinity ? ~0U : 0U;
        }
        if (found != 0) return false;
    }
    return true;
}

}  // namespace tex::python
