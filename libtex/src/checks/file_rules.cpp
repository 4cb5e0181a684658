// SPDX-License-Identifier: Apache-2.0

#include "checks/file_rules.h"

#include <algorithm>
#include <string>
#include <vector>

#include <tex/format.h>

#include "formats/row_source.h"
#include "rows/codecs.h"

namespace tex::inline v1 {
namespace {

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
    const FormatRow& row = format_row(texture.format);
    if (row.codec->has_grid && (extent.width % row.info.block.width != 0 || extent.height % row.info.block.height != 0))
        findings.add("N106", text);
    if (extent.width > require.max_extent || extent.height > require.max_extent) {
        findings.add("N107", text + "; the limit is " + std::to_string(require.max_extent));
    }
    if (require.extent && *require.extent != extent) {
        findings.add("N110", text + " instead of " + extent_text(*require.extent));
    }
}

template <class E, std::size_t N>
std::string names_of(const std::vector<E>& values, const Named<E> (&table)[N]) {
    std::string names;
    for (const E value : values) names += (names.empty() ? "" : ", ") + std::string(name_of(table, value));
    return names;
}

void check_engine(const CheckContext& context, const EngineNeeds& needs, Findings& findings) {
    std::vector<std::string> reasons;
    const auto type = container_of(context.file);
    if (type && std::find(needs.types.begin(), needs.types.end(), *type) == needs.types.end()) {
        reasons.push_back("does not read " + std::string(name_of(kContainerNames, *type)) + " but " +
                          names_of(needs.types, kContainerNames));
    }
    const Texture& texture = context.texture;
    const Swizzle& swizzle = context.stored.swizzle;
    const bool is_other = type == Container::ktx2 && !needs.in_ktx2.empty();
    const std::vector<Encoding>& encodings = is_other ? needs.in_ktx2 : needs.encodings;
    const auto holds = [&](Encoding encoding) { return holds_encoding(texture, swizzle, encoding); };
    // What reads glTF reads its UASTC (KHR_texture_basisu). An image of a model has no name that says its type.
    const bool is_read = std::any_of(encodings.begin(), encodings.end(), holds) || (!type && holds(Encoding::uastc));
    if (!is_read) {
        reasons.push_back("does not read normals from " + format_text(texture, swizzle) + " but from " +
                          names_of(encodings, kEncodingNames));
    }
    if (texture.zlib && !needs.inflates_zlib)
        reasons.emplace_back("does not read KTX2 that zlib compressed, but Zstandard (--supercompress zstd)");
    // Engines treat floats as they treat other pictures.
    if (is_read && context.stored.is_signed && format_info(texture.format).sample == SampleKind::floating)
        reasons.emplace_back("decodes 2c - 1, and the file holds x, y and z themselves, from -1 to 1");
    const int levels = static_cast<int>(texture.levels.size()), complete = level_count(texture.extent());
    const bool takes_levels = needs.levels || (is_read && format_info(texture.format).has_blocks());
    if (takes_levels && levels < complete)
        reasons.push_back("needs all " + std::to_string(complete) + " levels, and the file has " +
                          std::to_string(levels));
    std::string message;
    for (const std::string& reason : reasons) message += (message.empty() ? needs.engine + " " : "; it ") + reason;
    if (!message.empty()) findings.add("N113", message);
}

void check_astc_layout(const CheckContext& context, Findings& findings) {
    if (format_row(context.texture.format).codec->swizzle != kSwizzleXxxy || !context.has_vectors) return;
    if (same_layout(kSwizzleXxxy, context.stored.swizzle, 4)) return;
    findings.add("N115",
                 "the layout is " + layout_name(context.stored.swizzle) + " instead of " + layout_name(kSwizzleXxxy));
}

// UASTC and ETC1S of one channel: their descriptor says so.
void check_basis_channels(const CheckContext& context, Findings& findings) {
    if (!has_basis_blocks(context.texture.format) || context.stored.channel(Component::y) >= 0) return;
    findings.add("N114", std::string(name_of(kFormatNames, context.texture.format)) +
                             " of one channel: R, G and B hold the same values");
}

}  // namespace

void check_file_rules(const CheckContext& context, Findings& findings) {
    const Texture& texture = context.texture;
    const Requirements& require = context.options.require;
    for (const std::string& remark : texture.remarks) findings.add("N102", remark);
    if (texture.trailing_bytes > 0) findings.add("N104", trailing_text(texture.trailing_bytes));
    if (texture.orientation != 1)
        findings.add("N116", "the orientation is " + std::to_string(texture.orientation) + " instead of 1" +
                                 (texture.turned ? "" : ", and the texels were read as they are stored"));
    check_format(texture, context.stored.swizzle, require, findings);
    check_levels(texture, require, findings);
    check_extent(texture, require, findings);
    if (texture.srgb) findings.add("N111", format_text(texture, context.stored.swizzle) + ", as sRGB");
    check_astc_layout(context, findings);
    check_basis_channels(context, findings);
    for (const EngineNeeds& needs : require.engines) check_engine(context, needs, findings);
    if (require.y && texture.y_known && texture.y_axis != *require.y) {
        findings.add("N112", "the file says " + direction(texture.y_axis) + " instead of " + direction(*require.y));
    }
}

}  // namespace tex::inline v1
