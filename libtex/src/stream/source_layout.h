// SPDX-License-Identifier: Apache-2.0
// source_layout.h: chooses between the ways to find the layout of a file's normals: see SourceOptions.

#pragma once

#include <optional>

#include <tex/file.h>

namespace tex::inline v1 {

// The swizzle, if the texels are not needed to find it; nothing if guess_swizzle() must decide.
std::optional<Swizzle> known_swizzle(const Texture& head, const SourceOptions& options);

// The swizzle to use if guess_swizzle() has found `guess`.
Swizzle guessed_swizzle(const Swizzle& guess, const SourceOptions& options);

// known_swizzle(), or else what guess_swizzle() says. Errors: those of guess_swizzle().
Result<Swizzle> find_swizzle(const Texture& texture, const SourceOptions& options, const Execution& execution);

// What is known about a file whose normals have this swizzle. `head` needs no levels.
SourceInfo source_info(const Texture& head, const Swizzle& swizzle, const SourceOptions& options);

// The options with which the file's values are unpacked.
UnpackOptions unpack_options(const SourceInfo& info, const SourceOptions& options);

// Checks that the channels can hold normals. Errors: unsupported.
Result<void> check_channels(const Texture& head);

}  // namespace tex::inline v1
