// SPDX-License-Identifier: Apache-2.0
// source_layout.h: chooses between the ways to find the layout of a file's normals: see SourceOptions.

#pragma once

#include <optional>

#include <tex/file.h>

#include "rows/blue_evidence.h"
#include "rows/unpack_rows.h"

namespace tex::inline v1 {

// The swizzle, if the texels are not needed to find it; nothing if guess_swizzle() must decide.
std::optional<Swizzle> known_swizzle(const Texture& head, const SourceOptions& options);

// The swizzle that was found. The others are as in SourceInfo.
struct FoundSwizzle {
    Swizzle swizzle{};
    bool order_assumed = false;
    bool z01 = false;
};

// The swizzle to use if guess_swizzle() has found `guess`.
Swizzle guessed_swizzle(const Swizzle& guess, const SourceOptions& options);

// known_swizzle(), or else what guess_swizzle() says. Errors: those of guess_swizzle().
Result<FoundSwizzle> find_swizzle(const Texture& texture, const SourceOptions& options, const Execution& execution);

// What is known about a file whose normals have this swizzle. `head` needs no levels.
SourceInfo source_info(const Texture& head, const FoundSwizzle& found, const SourceOptions& options);

// The options with which the file's values are unpacked.
UnpackOptions unpack_options(const SourceInfo& info, const SourceOptions& options);

// Whether BlueEvidence must decide how z is read: nobody says it, and the three channels of a picture can hold it in
// more than one way.
[[nodiscard]] bool leaves_blue_open(const Texture& head, const SourceOptions& options);

// What the evidence means for a map. Errors: bad_data if x is not in the file.
Result<void> settle_blue(const BlueEvidence& blue, const Sources& sources, SourceOptions& options);

// Checks that the channels can hold normals. Errors: unsupported.
Result<void> check_channels(const Texture& head);

}  // namespace tex::inline v1
