// SPDX-License-Identifier: Apache-2.0
// tiff_uneven.h: TIFF files that libtiff does not open although they are sound.

#pragma once

namespace tex::reader {

// Whether the samples of the first picture differ in their bits or formats. The answer for damaged files is false, or
// as if they were sound.
bool has_uneven_samples();

}  // namespace tex::reader
