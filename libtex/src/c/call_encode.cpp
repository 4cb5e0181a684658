// SPDX-License-Identifier: Apache-2.0

#include <tex/pack.h>

#include "blocks/extent.h"
#include "c/call.h"
#include "rows/codecs.h"
#include "rows/pack_rows.h"
#include "rows/whole_vectors.h"

namespace tex::inline v1 {
namespace {

int32_t encode_options(const tex_encode_options* options, PackOptions& out) {
    tex_encode_options o;
    if (const int32_t error = copy_options(options, o); error != TEX_OK) return error;
    if (!is_one_of(o.encoding, kEncodingNames) || !is_one_of(o.effort, kEffortNames) ||
        !is_one_of(o.metric, kMetricNames) || !is_one_of(o.y_axis, kYAxisNames))
        return TEX_BAD_OPTION;
    out.encoding = static_cast<Encoding>(o.encoding);
    out.effort = static_cast<Effort>(o.effort);
    out.metric = static_cast<Metric>(o.metric);
    out.y_axis = static_cast<YAxis>(o.y_axis);
    return TEX_OK;
}

bool reads_z(Encoding encoding) {
    const Swizzle swizzle = encoding_info(encoding).swizzle;
    return std::find(swizzle.begin(), swizzle.end(), Component::z) != swizzle.end();
}

// What encode_whole_blocks() takes.
std::size_t scratch_of(const WholeBlocks& codec, const PackOptions& options, int width) {
    const Format format = encoding_info(options.encoding).format;
    const int rows = codec.rows_at_once(format, width);
    ScratchSize size;
    size.vector<float>(std::int64_t{codec.values} * width * rows * format_info(format).block.height);
    return size.bytes() + codec.memory(format, options.effort, width, rows);
}

void encode_whole_blocks(const WholeBlocks& codec, const tex_map& map, const PackOptions& options, int first, int end,
                         std::byte* out, std::size_t pitch) {
    const Format format = encoding_info(options.encoding).format;
    const int block = format_info(format).block.height, together = codec.rows_at_once(format, map.width) * block;
    const float side = options.y_axis == YAxis::down ? -1.0f : 1.0f;
    const std::size_t row_bytes = level_bytes(format, {map.width, 1});
    for (int top = first; top < end; top += together) {
        const int count = std::min(together, end - top);
        const std::ptrdiff_t of_row = std::ptrdiff_t{codec.values} * map.width;
        WorkingVector<float> texels(static_cast<std::size_t>(of_row * count));
        float* to = texels.data();
        for (int j = top; j < top + count; ++j) {
            const NormalRow row = row_of(map, j);
            for (int i = 0; i < map.width; ++i) {
                *to++ = row.x[i];
                *to++ = side * row.y[i];
                if (codec.values == 2) continue;
                *to++ = row.z[i];
                if (codec.values == 4) *to++ = 1.0f;
            }
        }
        // Rows of blocks may lie apart: they are encoded one by one then.
        const int step = pitch == row_bytes ? count : block;
        for (int j = 0; j < count; j += step) {
            codec.encode(format, options.effort, texels.data() + of_row * j, {map.width, std::min(step, count - j)},
                         out + static_cast<std::size_t>((top + j) / block) * pitch);
        }
    }
}

constexpr int kTexelChunk = 256;  // texels that are packed together, on the stack

void encode_texels(const tex_map& map, const PackOptions& options, int j, std::byte* out) {
    const auto [format, swizzle] = encoding_info(options.encoding);
    const FormatInfo info = format_info(format);
    alignas(std::uint32_t) std::byte packed[(kTexelChunk + kPackSlack) * 4 * sizeof(float)];
    float ends[3][kTexelChunk] = {};
    for (int i = 0; i < map.width; i += kTexelChunk) {
        const int count = std::min(kTexelChunk, map.width - i);
        const NormalRow row = row_of(map, j);
        VectorRow texels{row.x + i, row.y + i, row.z == nullptr ? nullptr : row.z + i};
        if (count % kWhole != 0) {
            std::copy_n(texels.x, count, ends[0]);
            std::copy_n(texels.y, count, ends[1]);
            if (reads_z(options.encoding)) std::copy_n(texels.z, count, ends[2]);
            texels = {ends[0], ends[1], ends[2]};
        }
        PackChannel channels[4];
        pack_channels(texels, swizzle, options.y_axis == YAxis::down, nullptr, nullptr, channels);
        const std::size_t bytes = pack_texels(info, channels, count, packed);
        std::memcpy(out + static_cast<std::size_t>(i) * info.block_bytes, packed, bytes);
    }
}

}  // namespace
}  // namespace tex::inline v1

using namespace tex;

int32_t tex_encode_prepare(const tex_encode_options* options) {
    PackOptions o;
    if (const int32_t error = encode_options(options, o); error != TEX_OK) return error;
    const WholeBlocks* const codec = whole_blocks(o.encoding);
    if (codec == nullptr) return TEX_OK;
    try {
        codec->prepare(encoding_info(o.encoding).format, o.effort);
    } catch (const std::bad_alloc&) {
        return TEX_OUT_OF_MEMORY;
    }
    return TEX_OK;
}

size_t tex_encode_size(int32_t width, const tex_encode_options* options) {
    PackOptions o;
    if (!is_extent(width, 1) || encode_options(options, o) != TEX_OK) return 0;
    const WholeBlocks* const codec = whole_blocks(o.encoding);
    return codec != nullptr ? scratch_of(*codec, o, width) : 0;
}

int32_t tex_encode(const tex_map* map, const tex_encode_options* options, int32_t first, int32_t end, void* bytes,
                   size_t pitch, void* scratch, size_t scratch_size) {
    PackOptions o;
    if (const int32_t error = encode_options(options, o); error != TEX_OK) return error;
    const Format format = encoding_info(o.encoding).format;
    const int block = format_info(format).block.height;
    if (!is_map(map, reads_z(o.encoding)) || bytes == nullptr || !are_blocks(first, end, map->height, block) ||
        pitch < level_bytes(format, {map->width, 1}))
        return TEX_BAD_ARGUMENT;
    const WholeBlocks* const codec = whole_blocks(o.encoding);
    if (codec != nullptr && !codec->is_prepared(format, o.effort)) return TEX_NOT_PREPARED;
    auto* const out = static_cast<std::byte*>(bytes);
    if (codec != nullptr) {
        return with_scratch(scratch, scratch_size, scratch_of(*codec, o, map->width), [&] {
            encode_whole_blocks(*codec, *map, o, first, end, out, pitch);
            return TEX_OK;
        });
    }
    if (first == end) return TEX_OK;
    if (block > 1) {
        const Extent extent{map->width, end - first};
        const NormalRow row = row_of(tex_map{map->x, map->y, map->y, map->stride, 0, 0}, first);
        if (!encode_blocks({row.x, extent, map->stride}, {row.y, extent, map->stride}, o,
                           out + static_cast<std::size_t>(first / block) * pitch, pitch))
            return TEX_BAD_ARGUMENT;
        return TEX_OK;
    }
    for (int j = first; j < end; ++j) encode_texels(*map, o, j, out + static_cast<std::size_t>(j) * pitch);
    return TEX_OK;
}
