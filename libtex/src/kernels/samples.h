// SPDX-License-Identifier: Apache-2.0
// samples.h: samples as files store them, to floats.

#pragma once

#include <cstddef>

#include <tex/format.h>

namespace tex {

// Decodes `count` samples of one channel, each of `bits` bits (8 or 16; 16 or 32 where floating), `step` bytes apart,
// little-endian. Values: see decode() in unpack.h; halves keep what a NaN carries.
void decode_samples(SampleKind sample, int bits, const std::byte* first, std::size_t step, int count, float* out);

}  // namespace tex
