// SPDX-License-Identifier: Apache-2.0
#include "finite.h"

#include <cstdint>
#include <cstring>

namespace tex::python {

bool is_finite(PlaneView<const float> plane) {
    constexpr std::uint32_t kInfinity = 0x7f800000U;
    for (int j = 0; j < plane.extent.height; ++j) {
        const float* const row = plane.row(j);
        std::uint32_t largest = 0;  // of the bits without the sign, which order as the magnitudes do
        for (int i = 0; i < plane.extent.width; ++i) {
            std::uint32_t bits = 0;
            std::memcpy(&bits, row + i, sizeof bits);
            bits &= 0x7fffffffU;
            largest = bits > largest ? bits : largest;
        }
        if (largest >= kInfinity) return false;
    }
    return true;
}

}  // namespace tex::python
