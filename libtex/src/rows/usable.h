// SPDX-License-Identifier: Apache-2.0
// usable.h: whether what a caller hands over can be worked on. Every verb asks first. Errors: bad_option.

#pragma once

#include <string_view>

#include <tex/format.h>
#include <tex/types.h>

namespace tex::inline v1 {

// The Error for an option out of its range: "gaussian_sigma: must be above 0 and at most 64".
[[nodiscard]] Error bad_option(std::string_view reason);

// An extent of at least 1x1 and at most kMaxExtent, of `what`: "the map".
[[nodiscard]] Result<void> check_usable(Extent extent, std::string_view what);
// Planes of one such extent; a picture has at least one, and a name for each.
[[nodiscard]] Result<void> check_usable(const NormalMap& map);
[[nodiscard]] Result<void> check_usable(const Image& image);
// At least one level; the extents are those of level_extent().
[[nodiscard]] Result<void> check_usable(const MipChain& chain);
// The same, and each level has level_bytes() bytes.
[[nodiscard]] Result<void> check_usable(const Texture& texture);

}  // namespace tex::inline v1
