// SPDX-License-Identifier: Apache-2.0
// unpack_rows.h: how unpack() reads channels: which of them, and whether stored floats are signed.

#pragma once

#include <optional>
#include <string>

#include <tex/image.h>
#include <tex/result.h>
#include <tex/unpack.h>

#include "kernels/unpack.h"

namespace tex {

// Which of four channels hold x, y and z; -1 for none.
struct Sources {
    int x = -1;
    int y = -1;
    int z = -1;
};

// Of a file with one channel.
inline constexpr const char* kOneChannel = "has one channel, which holds no normals (bake-normals reads heights)";

// `available` channels can be read: bit c for channel c. Errors: bad_option, as unpack().
Result<Sources> sources_of(const Swizzle& swizzle, unsigned available);

// What the options say of ValueRange, or else the file.
ValueRange range_of(const std::string& normal_encoding, const UnpackOptions& options);

// Whether values are (n + 1) / 2, where that does not depend on them; else nothing.
std::optional<bool> is_unsigned(SampleKind sample, ValueRange range);

// All of the rule but `is_unsigned`.
UnpackRule rule_of(const UnpackOptions& options, SampleKind sample, int bits, YAxis y_axis);

// What values say about ValueRange. Rows are weighed in any order and added in theirs.
struct RangeEvidence {
    bool negative = false;
    double off_signed = 0.0;    // how far the vectors are from unit length, read as signed
    double off_unsigned = 0.0;  // and as unsigned

    void add(const RangeEvidence& row) {
        negative = negative || row.negative;
        off_signed += row.off_signed;
        off_unsigned += row.off_unsigned;
    }
    [[nodiscard]] bool says_unsigned() const { return !negative && off_unsigned <= off_signed; }
};

// z may be null.
RangeEvidence weigh_row(const float* x, const float* y, const float* z, int count);

}  // namespace tex
