// SPDX-License-Identifier: Apache-2.0

#include <tex/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "blocks/extent.h"
#include "rows/codecs.h"

namespace tex::inline v1 {
ExtraSet can_hold(Encoding encoding) {
    const auto [format, swizzle] = encoding_info(encoding);
    const FormatInfo info = format_info(format);
    const bool has_z = swizzle[2] == Component::z;
    const bool has_texels = !info.has_blocks();
    const WholeBlocks* const whole = whole_blocks(encoding);
    const bool has_alpha = info.channels == 4 && (whole == nullptr || whole->values == 4);
    return {has_z && has_texels, has_alpha && swizzle[3] == Component::one, has_z && has_texels};
}

bool can_optimise(Encoding encoding) {
    const WholeBlocks* const whole = whole_blocks(encoding);
    return codec_of(encoding).encode_halves != nullptr || (whole != nullptr && whole->optimise != nullptr);
}

float steepest_slope(Encoding encoding) {
    const EncodingInfo info = encoding_info(encoding);
    const FormatInfo format = format_info(info.format);
    if (format.sample == SampleKind::floating) return std::numeric_limits<float>::infinity();
    const bool has_z = std::find(info.swizzle.begin(), info.swizzle.end(), Component::z) != info.swizzle.end();
    // In codes: the range from 0 to 1.
    const double half_range = 0.5 * (std::pow(2.0, format.bits) - (format.sample == SampleKind::snorm ? 2 : 1));
    if (has_z) return static_cast<float>(half_range);
    const double x = 1.0 - 0.5 / half_range;
    return static_cast<float>(x / std::sqrt(1.0 - x * x));
}

std::size_t level_bytes(Format format, Extent extent) {
    const FormatInfo info = format_info(format);
    return static_cast<std::size_t>(blocks_across(extent.width, info.block.width)) *
           static_cast<std::size_t>(blocks_across(extent.height, info.block.height)) * info.block_bytes;
}

std::string to_string(const Swizzle& swizzle) {
    std::string letters;
    for (const Component component : swizzle) letters += name_of(kComponentNames, component);
    return letters;
}

}  // namespace tex::inline v1
