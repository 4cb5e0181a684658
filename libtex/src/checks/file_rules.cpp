// SPDX-License-Identifier: Apache-2.0

#include "checks/file_rules.h"

#include <string>

#include <tex/swizzle.h>

namespace tex {
namespace {

constexpr std::string_view kTrailing = "after the last level";

bool is_power_of_two(int n) { return (n & (n - 1)) == 0; }

// Describes a texture, for example "bc3-unorm, dxt5nm".
std::string format_text(const Texture& texture, const Swizzle& swizzle) {
    return std::string(name_of(kFormatNames, texture.format)) + ", " + layout_name(swizzle);
}

// Whether two swizzles hold the same components. Channels that the encoding leaves open may hold anything.
bool same_layout(const Swizzle& wanted, const Swizzle& stored, int channels) {
    for (std::size_t c = 0; c < static_cast<std::size_t>(channels); ++c) {
        const auto holds = [](Component k) { return k == Component::x || k == Component::y || k == Component::z; };
        if ((holds(wanted[c]) || holds(stored[c])) && wanted[c] != stored[c]) return false;
    }
    return true;
}

// A picture that is not compressed may have one alpha channel more or less than the encoding, because pictures store no
// swizzle.
bool holds_encoding(const Texture& texture, const Swizzle& swizzle, Encoding encoding) {
    const EncodingInfo info = encoding_info(encoding);
    const auto widened = [](Format format) {
        return format == Format::rgb16_float   ? Format::rgba16_float
               : format == Format::rgb32_float ? Format::rgba32_float
               : format == Format::rgb16_unorm ? Format::rgba16_unorm
                                               : format;
    };
    return widened(texture.format) == widened(info.format) &&
           same_layout(info.swizzle, swizzle, format_info(texture.format).channels);
}

void check_format(const Texture& texture, const Swizzle& swizzle, const Requirements& require, Findings& findings) {
    std::string_view wanted;
    if (require.encoding && !holds_encoding(texture, swizzle, *require.encoding))
        wanted = name_of(kEncodingNames, *require.encoding);
    if (require.format && *require.format != texture.format) wanted = name_of(kFormatNames, *require.format);
    if (!wanted.empty()) findings.add("N108", format_text(texture, swizzle) + " instead of " + std::string(wanted));
}

void check_levels(const Texture& texture, const Requirements& require, Findings& findings) {
    const int levels = static_cast<int>(texture.levels.size());
    const int complete = level_count(texture.extent());
    if (levels > 1 && levels < complete) {
        findings.add("N103", std::to_string(levels) + " levels, the last of " +
                                 extent_text(texture.levels.back().extent) + "; a complete chain has " +
                                 std::to_string(complete));
    }
    if (!require.levels) return;
    const int wanted = *require.levels == 0 ? complete : *require.levels;
    if (levels != wanted) {
        findings.add("N109", std::to_string(levels) + (levels == 1 ? " level" : " levels") + " instead of " +
                                 std::to_string(wanted));
    }
}

void check_extent(const Texture& texture, const Requirements& require, Findings& findings) {
    const Extent extent = texture.extent();
    const std::string text = extent_text(extent);
    if (!is_power_of_two(extent.width) || !is_power_of_two(extent.height)) findings.add("N105", text);
    const Extent block = format_info(texture.format).block;
    if (extent.width % block.width != 0 || extent.height % block.height != 0) findings.add("N106", text);
    if (extent.width > require.max_extent || extent.height > require.max_extent) {
        findings.add("N107", text + "; the limit is " + std::to_string(require.max_extent));
    }
    if (require.extent && *require.extent != extent) {
        findings.add("N110", text + " instead of " + extent_text(*require.extent));
    }
}

}  // namespace

void check_file_rules(const Subject& subject, Findings& findings) {
    const Texture& texture = subject.texture;
    const Requirements& require = subject.options.require;
    for (const std::string& remark : texture.remarks) {
        findings.add(remark.find(kTrailing) != std::string::npos ? "N104" : "N102", remark);
    }
    check_format(texture, subject.stored.swizzle, require, findings);
    check_levels(texture, require, findings);
    check_extent(texture, require, findings);
    if (texture.srgb) findings.add("N111", format_text(texture, subject.stored.swizzle) + ", as sRGB");
    if (require.y && texture.y_known && texture.y_axis != *require.y) {
        findings.add("N112", "the file says " + direction(texture.y_axis) + " instead of " + direction(*require.y));
    }
}

}  // namespace tex
