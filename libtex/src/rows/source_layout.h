// SPDX-License-Identifier: Apache-2.0
// source_layout.h: which of the ways to find out the layout of a file's normals counts: see SourceOptions.

#pragma once

#include <optional>

#include <tex/source.h>

namespace tex {

// The swizzle that needs no look at the texels; nothing where guess_swizzle() decides.
std::optional<Swizzle> known_swizzle(const Texture& head, const SourceOptions& options);

// The swizzle to take where guess_swizzle() has found `guess`.
Swizzle guessed_swizzle(const Swizzle& guess, const SourceOptions& options);

// What is known of a file whose normals have this swizzle. `head` needs no levels.
SourceInfo source_info(const Texture& head, const Swizzle& swizzle, const SourceOptions& options);

// How the file's values are unpacked.
UnpackOptions unpack_options(const SourceInfo& info, const SourceOptions& options);

// Errors: unsupported.
Result<void> check_channels(const Texture& head);

}  // namespace tex
