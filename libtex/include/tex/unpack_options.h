// SPDX-License-Identifier: Apache-2.0
// unpack_options.h: how stored values are read: see unpack.h.

#pragma once

#include <optional>

#include <tex/names.h>
#include <tex/normal_map.h>
#include <tex/texture.h>

#pragma GCC visibility push(default)
namespace tex {

// How stored floats are read. (Integers are unambiguous: unorm is unsigned, snorm is signed.)
enum class ValueRange {
    automatic,  // as the file states; else by the values, see unpack()
    signed_,    // components of the normal themselves
    unsigned_,  // (n + 1) / 2
};

inline constexpr Named<ValueRange> kValueRangeNames[] = {
    {ValueRange::automatic, "auto", "as the file says, else by the values"},
    {ValueRange::signed_, "signed", "floats are the normal's components, -1 to 1"},
    {ValueRange::unsigned_, "unsigned", "floats are (n + 1) / 2, 0 to 1"},
};

struct UnpackOptions {
    std::optional<Swizzle> swizzle;            // instead of the texture's own
    std::optional<YAxis> y_axis;               // instead of the texture's own; without it, y is up in pictures
    ValueRange range = ValueRange::automatic;  // for floats only
    bool snap_flat = false;                    // 8-bit unorm values from 127/255 to 128/255 are 0, not -+0.0039
    bool keep_length = false;                  // do not normalise vectors, to pack them again without loss
    bool keep_invalid = false;                 // vectors that are not finite become NaN, not (0, 0, 1)
    // Which data beside the normals go along: NormalMap::blue is B as it is stored, if it holds no part of the normals,
    // and so is NormalMap::alpha, unless it is 1 everywhere; NormalMap::length is what the lengths of vectors hold, if
    // z is stored. Lengths are data only if this says so.
    OtherPlanes others = {false, true, false};

    friend bool operator==(const UnpackOptions&, const UnpackOptions&) = default;
};

}  // namespace tex
#pragma GCC visibility pop
