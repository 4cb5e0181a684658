// SPDX-License-Identifier: Apache-2.0
// samples.h: converts samples as files store them to floats.

#pragma once

#include <cstddef>

#include <tex/format.h>

namespace tex::inline v1 {

// Decodes `count` samples of one channel, each of `bits` bits (8 or 16; 16 or 32 if floating), `step` bytes apart,
// little-endian. For the values, see decode() in pack.h; halves keep the payload of a NaN.
void decode_samples(SampleKind sample, int bits, const std::byte* first, std::size_t step, int count, float* out);

}  // namespace tex::inline v1
