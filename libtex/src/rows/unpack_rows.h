// SPDX-License-Identifier: Apache-2.0
// unpack_rows.h: how unpack() reads channels: which channels it reads, and whether stored floats are signed.

#pragma once

#include <array>
#include <optional>
#include <string>

#include <tex/pack.h>
#include <tex/types.h>

#include "kernels/normal_row.h"
#include "kernels/unpack.h"

namespace tex::inline v1 {

// The channels, of four, that hold x, y and z; -1 if none does.
struct Sources {
    int x = -1;
    int y = -1;
    int z = -1;
};

// Which channels hold them and these extras.
[[nodiscard]] std::array<bool, 4> channels_read(const Sources& sources, ExtraSet extras);

// The rows of x, y and z among those of channels; z may be null.
[[nodiscard]] inline VectorRow vectors_of(const float* const (&channels)[4], const Sources& sources) {
    return {channels[sources.x], channels[sources.y], sources.z < 0 ? nullptr : channels[sources.z]};
}

// What a format, which has so many channels, may hold beside the normals: channels that hold no part of them, and the
// lengths of vectors.
[[nodiscard]] ExtraSet extras_beside(const Sources& sources, int channels);

// The message for a file with one channel.
inline constexpr const char* kOneChannel = "has one channel, which holds no normals (bake-normals reads heights)";

// Finds the sources among the `available` channels: bit c is set if channel c can be read. Errors: bad_option, as
// unpack().
Result<Sources> sources_of(const Swizzle& swizzle, unsigned available);

// The ValueRange that the options give, or else the one that the file gives.
ValueRange range_of(const std::string& normal_encoding, const UnpackOptions& options);

// Whether values are (n + 1) / 2, if that does not depend on the values; else nothing.
std::optional<bool> is_unsigned(SampleKind sample, ValueRange range);

// The whole rule except `is_unsigned`.
UnpackRule rule_of(const UnpackOptions& options, SampleKind sample, int bits, YAxis y_axis);

// What values show about ValueRange. Rows may be weighed in any order, but must be added in their order.
struct RangeEvidence {
    bool negative = false;
    double off_signed = 0.0;    // deviation of the vectors from unit length, read as signed
    double off_unsigned = 0.0;  // the same, read as unsigned

    void add(const RangeEvidence& row) {
        negative = negative || row.negative;
        off_signed += row.off_signed;
        off_unsigned += row.off_unsigned;
    }
    [[nodiscard]] bool says_unsigned() const { return !negative && off_unsigned <= off_signed; }
};

// z may be null.
RangeEvidence weigh_row(const float* x, const float* y, const float* z, int count);

}  // namespace tex::inline v1
