// SPDX-License-Identifier: Apache-2.0

#include <tex/check.h>
#include <tex/types.h>

#include "c/call.h"
#include "threads/no_throw.h"

namespace tex::inline v1 {
namespace {

bool are_levels(const tex_texels* levels, int32_t count) {
    if (levels == nullptr || count < 1 || !is_extent(levels[0].width, levels[0].height)) return false;
    const Extent base{levels[0].width, levels[0].height};
    if (count > level_count(base) || !is_one_of(levels[0].format, kFormatNames)) return false;
    for (int32_t k = 0; k < count; ++k) {
        const tex_texels& level = levels[k];
        const Extent extent = level_extent(base, k);
        if (level.bytes == nullptr || level.format != levels[0].format || Extent{level.width, level.height} != extent ||
            level.pitch != level_bytes(static_cast<Format>(level.format), {extent.width, 1}))
            return false;
    }
    return true;
}

Texture texture_of(const tex_texels* levels, int32_t count) {
    Texture texture;
    texture.format = static_cast<Format>(levels[0].format);
    for (int32_t k = 0; k < count; ++k) {
        Level level;
        level.extent = {levels[k].width, levels[k].height};
        const auto* const bytes = static_cast<const std::byte*>(levels[k].bytes);
        level.bytes.assign(bytes, bytes + level_bytes(texture.format, level.extent));
        texture.levels.push_back(std::move(level));
    }
    if (format_info(texture.format).channels == 2) texture.swizzle = kSwizzleXy;
    return texture;
}

void write_finding(const Finding& finding, tex_finding* to) {
    tex_finding made = {};
    std::copy_n(finding.rule->id.data(), std::min(finding.rule->id.size(), sizeof made.id - 1), made.id);
    made.severity = static_cast<int32_t>(finding.severity);
    made.level = finding.regions.empty() ? 0 : finding.regions.front().level;
    made.column = finding.has_texel ? finding.column : -1;
    made.row = finding.has_texel ? finding.row : -1;
    made.figure = finding.figure;
    made.confidence = finding.confidence;
    // A sentence that is cut ends with a whole character of UTF-8.
    std::size_t length = std::min(finding.message.size(), sizeof made.message - 1);
    const auto continues = [&](std::size_t at) {
        return (static_cast<unsigned char>(finding.message[at]) & 0xc0) == 0x80;
    };
    while (length < finding.message.size() && length > 0 && continues(length)) --length;
    std::copy_n(finding.message.data(), length, made.message);
    write_report(made, to);
}

int32_t check_levels(const tex_texels* levels, int32_t level_count, const tex_check_options& o, tex_finding* findings,
                     std::size_t capacity, std::size_t* count) {
    Texture texture = texture_of(levels, level_count);
    if (std::any_of(o.swizzle, o.swizzle + 4, [](uint8_t c) { return c != TEX_ZERO; })) {
        for (std::size_t k = 0; k < 4; ++k) texture.swizzle[k] = static_cast<Component>(o.swizzle[k]);
        texture.swizzle_known = true;
    }
    CheckOptions options;
    if (o.y_axis >= 0) options.require.y = static_cast<YAxis>(o.y_axis);
    options.require.tiles = o.tiles == 1;
    const auto report = check({}, texture, options, Execution{1, {}});
    if (!report) return report.error().code == ErrorCode::bad_option ? TEX_BAD_OPTION : TEX_OUT_OF_MEMORY;
    *count = report->findings.size();
    auto* bytes = reinterpret_cast<unsigned char*>(findings);
    const std::size_t step = capacity == 0 ? 0 : findings->size;
    for (std::size_t k = 0; k < std::min(capacity, report->findings.size()); ++k, bytes += step) {
        auto* const to = reinterpret_cast<tex_finding*>(bytes);
        to->size = static_cast<std::uint32_t>(step);
        write_finding(report->findings[k], to);
    }
    return TEX_OK;
}

}  // namespace
}  // namespace tex::inline v1

using namespace tex;

int32_t tex_check(const tex_texels* levels, int32_t level_count, const tex_check_options* options,
                  tex_finding* findings, size_t capacity, size_t* count) {
    if (!are_levels(levels, level_count) || count == nullptr) return TEX_BAD_ARGUMENT;
    if (capacity > 0 && (findings == nullptr || !is_report(findings))) return TEX_BAD_ARGUMENT;
    tex_check_options o;
    if (const int32_t error = copy_options(options, o); error != TEX_OK) return error;
    if (o.y_axis < -1 || o.y_axis > TEX_Y_DOWN || (o.tiles != 0 && o.tiles != 1)) return TEX_BAD_OPTION;
    if (std::any_of(o.swizzle, o.swizzle + 4, [](uint8_t c) { return c > TEX_OTHER; })) return TEX_BAD_OPTION;
    try {
        return check_levels(levels, level_count, o, findings, capacity, count);
    } catch (const std::bad_alloc&) {
        return TEX_OUT_OF_MEMORY;
    } catch (const std::length_error&) {
        return TEX_OUT_OF_MEMORY;
    }
}
