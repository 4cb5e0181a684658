// SPDX-License-Identifier: Apache-2.0
// astc_endpoints.h: the colours between which the texels of a partition interpolate, from the values that a block
// stores. (Khronos Data Format Specification 1.3, "Color Endpoint Decoding".)

#pragma once

#include <cstdint>

namespace tex::inline v1 {

// The modes of endpoints that encoders use; a mode has 2 (mode / 4) + 2 values.
inline constexpr int kAstcLuminance = 0;
inline constexpr int kAstcLuminanceOffset = 1;
inline constexpr int kAstcLuminanceAlpha = 4;
inline constexpr int kAstcLuminanceAlphaOffset = 5;

constexpr int astc_endpoint_values(int mode) { return 2 * (mode / 4) + 2; }

struct AstcEndpoints {
    int color[2][4];  // R, G, B, A, 0 to 255
};

// The endpoints of a mode, 0 to 15. Modes of high dynamic range give magenta at both ends, as libastcenc does in its
// profile for low dynamic range.
[[nodiscard]] AstcEndpoints astc_endpoints(int mode, const std::uint8_t* values);

}  // namespace tex::inline v1
