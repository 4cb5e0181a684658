// SPDX-License-Identifier: Apache-2.0
// texel_sums.h: sums of texels that other programs decoded (FNV-1a, 64 bits).

#pragma once

#include <cstdint>

namespace tex {

class TexelSum {
public:
    void add(std::uint8_t code) { value_ = (value_ ^ code) * 0x100000001b3; }
    [[nodiscard]] std::uint64_t value() const { return value_; }

private:
    std::uint64_t value_ = 0xcbf29ce484222325;
};

}  // namespace tex
