// SPDX-License-Identifier: Apache-2.0
// stored_samples.h: what a file says about its samples besides their values.

#pragma once

#include <cstdint>

namespace tex::inline v1 {

// The reader process hands over integers as they are stored; RowSource::store() makes them fractions of the largest
// one.
struct StoredSamples {
    std::uint32_t kind = 0;  // as TIFF numbers them: 1 unsigned, 2 signed, 3 floating; 0 if the file does not say
    std::uint32_t bits = 0;
    std::uint32_t has_place = 0;  // GeoTIFF: the picture has a place on the Earth, so its samples have a unit
    std::uint32_t has_scale = 0;  // GDAL: the value is scale * sample + offset
    double scale = 1;
    double offset = 0;
};

}  // namespace tex::inline v1
