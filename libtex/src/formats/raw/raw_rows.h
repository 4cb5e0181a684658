// SPDX-License-Identifier: Apache-2.0
// raw_rows.h: rows of bare numbers, at regular places of a file: what raw heights, HGT and BIL have in common.

#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "files/input_file.h"
#include "formats/row_source.h"

namespace tex::inline v1 {

struct RawSamples {
    SampleKind kind = SampleKind::unorm;
    int bits = 16;  // 8, 16 or 32; floats have 32
    bool big_endian = false;

    [[nodiscard]] std::size_t bytes() const { return static_cast<std::size_t>(bits / 8); }
};

struct RawTexels {
    Extent extent = {};
    RawSamples samples = {};
    std::int64_t first = 0;             // the place of the first texel
    std::size_t pitch = 0;              // bytes from a row to the next; 0: rows follow each other without a gap
    bool has_place = false;             // on the Earth, so that the samples have a unit (StoredSamples::has_place)
    std::optional<float> no_data = {};  // as the file stores it
    std::string remark = {};            // PictureHead::remark
    GridPlace place = {};               // StoredSamples::place

    // The number of bytes up to the last texel. Does not overflow: at most 2^41 texels of 4 bytes, and a pitch that the
    // caller has checked.
    [[nodiscard]] std::int64_t end() const;
};

// One channel, Y. The file must outlive the rows and have place.end() bytes. Several threads may decode at once.
std::unique_ptr<RowSource> open_raw_rows(const InputFile& file, RawTexels place);

}  // namespace tex::inline v1
