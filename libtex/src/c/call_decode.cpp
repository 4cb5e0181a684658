// SPDX-License-Identifier: Apache-2.0

#include <tex/pack.h>

#include "c/call.h"
#include "kernels/unpack.h"
#include "rows/stored_rows.h"
#include "rows/unpack_rows.h"
#include "rows/whole_vectors.h"

namespace tex::inline v1 {
namespace {

bool are_texels(const tex_texels* texels) {
    return texels != nullptr && texels->bytes != nullptr && is_extent(texels->width, texels->height) &&
           is_one_of(texels->format, kFormatNames) &&
           texels->pitch >= level_bytes(static_cast<Format>(texels->format), {texels->width, 1});
}

StoredRows stored(const tex_texels& texels) {
    const auto format = static_cast<Format>(texels.format);
    return {static_cast<const std::byte*>(texels.bytes),
            texels.pitch,
            format,
            format_info(format),
            texels.width,
            texels.height};
}

int find_channel(const uint8_t (&swizzle)[4], int component) {
    const auto* const found = std::find(swizzle, swizzle + 4, component);
    return found == swizzle + 4 ? -1 : static_cast<int>(found - swizzle);
}

int32_t unpack_sources(const tex_unpack_options& options, const FormatInfo& info, Sources& out) {
    uint8_t swizzle[4] = {TEX_X, TEX_Y, info.channels > 2 ? uint8_t{TEX_Z} : uint8_t{TEX_ZERO}, TEX_OTHER};
    const bool given = std::any_of(options.swizzle, options.swizzle + 4, [](uint8_t c) { return c != TEX_ZERO; });
    if (given) std::copy_n(options.swizzle, 4, swizzle);
    if (std::any_of(swizzle, swizzle + 4, [](uint8_t c) { return c > TEX_OTHER; })) return TEX_BAD_OPTION;
    out = {find_channel(swizzle, TEX_X), find_channel(swizzle, TEX_Y), find_channel(swizzle, TEX_Z)};
    if (out.x < 0 || out.y < 0 || std::max({out.x, out.y, out.z}) >= info.channels) return TEX_BAD_OPTION;
    return TEX_OK;
}

int32_t unpack_rule(const tex_unpack_options& o, const FormatInfo& info, UnpackRule& out) {
    for (const int32_t flag : {o.range, o.snap_flat, o.keep_length, o.keep_invalid}) {
        if (flag != 0 && flag != 1) return TEX_BAD_OPTION;
    }
    if (!is_one_of(o.y_axis, kYAxisNames)) return TEX_BAD_OPTION;
    UnpackOptions options;
    options.range = o.range == TEX_RANGE_UNSIGNED ? ValueRange::unsigned_ : ValueRange::signed_;
    options.snap_flat = o.snap_flat == 1;
    options.keep_length = o.keep_length == 1;
    options.keep_invalid = o.keep_invalid == 1;
    out = rule_of(options, info.sample, info.bits, static_cast<YAxis>(o.y_axis));
    out.is_unsigned = is_unsigned(info.sample, options.range).value_or(false);
    return TEX_OK;
}

void unpack_strip(const StoredRows& from, int j, const Sources& sources, const UnpackRule& rule, const tex_map& out) {
    const int rows = std::min(from.info.block.height, from.height - j);
    bool wanted[4];
    for (int c = 0; c < 4; ++c) wanted[c] = c == sources.x || c == sources.y || c == sources.z;
    StripOnStack strip;
    for (int i = 0; i < from.width; i += kDecodeChunk) {
        const int count = std::min(kDecodeChunk, from.width - i);
        from.decode(j, i, count, strip.rows(wanted), kDecodeChunk);
        for (int r = 0; r < rows; ++r) {
            const NormalRow to = row_of(out, j + r);
            const bool has_z = sources.z >= 0;
            const float* const from_rows[] = {strip.row(sources.x, r), strip.row(sources.y, r),
                                              strip.row(has_z ? sources.z : sources.x, r)};
            float* const to_rows[] = {to.x + i, to.y + i, to.z + i};
            in_whole_vectors(count, from_rows, to_rows, [&](const float* const* in, float* const* made, int texels) {
                unpack_row(in[0], in[1], has_z ? in[2] : nullptr, rule, texels, made[0], made[1], made[2]);
            });
        }
    }
}

}  // namespace
}  // namespace tex::inline v1

using namespace tex;

int32_t tex_decode(const tex_texels* texels, int32_t first, int32_t end, const tex_channels* out) {
    if (!are_texels(texels) || out == nullptr || out->stride < texels->width) return TEX_BAD_ARGUMENT;
    const StoredRows from = stored(*texels);
    const int block = from.info.block.height;
    if (!are_blocks(first, end, texels->height, block)) return TEX_BAD_ARGUMENT;
    for (int c = from.info.channels; c < 4; ++c) {
        if (out->channel[c] != nullptr) return TEX_BAD_ARGUMENT;
    }
    for (int j = first; j < end; j += block) from.decode_exactly(j, out->channel, out->stride);
    return TEX_OK;
}

int32_t tex_unpack(const tex_texels* texels, const tex_unpack_options* options, int32_t first, int32_t end,
                   const tex_map* out) {
    if (!are_texels(texels) || !is_map(out) || !same_extent(*texels, *out)) return TEX_BAD_ARGUMENT;
    const StoredRows from = stored(*texels);
    const int block = from.info.block.height;
    if (!are_blocks(first, end, texels->height, block)) return TEX_BAD_ARGUMENT;
    tex_unpack_options o;
    if (const int32_t error = copy_options(options, o); error != TEX_OK) return error;
    Sources sources;
    UnpackRule rule;
    if (const int32_t error = unpack_sources(o, from.info, sources); error != TEX_OK) return error;
    if (const int32_t error = unpack_rule(o, from.info, rule); error != TEX_OK) return error;
    for (int j = first; j < end; j += block) unpack_strip(from, j, sources, rule, *out);
    return TEX_OK;
}
