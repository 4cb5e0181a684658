// SPDX-License-Identifier: Apache-2.0

#include "formats/stored_texture.h"

#include <span>
#include <utility>

#include "blocks/extent.h"
#include "formats/file_layout.h"
#include "formats/ktx2/level_inflater.h"

namespace tex::inline v1 {

namespace {

// Bytes of a row without those between the rows.
std::size_t stored_row_bytes(const StoredTexture& texture, int width) {
    if (texture.fields) return static_cast<std::size_t>(width) * static_cast<std::size_t>(texture.fields->texel_bytes);
    return level_bytes(texture.head.format, {width, 1});
}

// Converts rows that have no bytes between them.
void convert_texels(const StoredTexture& texture, const std::byte* source, int width, int count, std::byte* target) {
    const Format format = texture.head.format;
    if (texture.fields) {
        convert_fields(*texture.fields, source, static_cast<std::size_t>(width) * static_cast<std::size_t>(count),
                       format, target);
        return;
    }
    const std::size_t bytes = level_bytes(format, {width, 1}) * static_cast<std::size_t>(count);
    rearrange_texels(format, texture.bgr ? Rearrange::bgr : Rearrange::none, source,
                     bytes / format_info(format).block_bytes, target);
}

}  // namespace

std::size_t stored_pitch(const StoredTexture& texture, int width) {
    const std::size_t bytes = stored_row_bytes(texture, width), step = texture.row_alignment;
    return (bytes + step - 1) / step * step;
}

bool is_as_in_memory(const StoredTexture& texture, int width) {
    return !texture.fields && !texture.bgr && stored_pitch(texture, width) == stored_row_bytes(texture, width);
}

void convert_rows(const StoredTexture& texture, const std::byte* source, int width, int count, std::byte* target) {
    const std::size_t pitch = stored_pitch(texture, width);
    if (pitch == stored_row_bytes(texture, width)) return convert_texels(texture, source, width, count, target);
    const std::size_t row = level_bytes(texture.head.format, {width, 1});
    for (int j = 0; j < count; ++j, source += pitch, target += row) convert_texels(texture, source, width, 1, target);
}

Result<Texture> load_texture(ParseTexture parse, const std::byte* data, std::size_t size, const std::string& name,
                             const ReadOptions& options) {
    const FetchBytes fetch = [data](std::uint64_t offset, std::size_t count) -> Result<std::vector<std::byte>> {
        return std::vector<std::byte>(data + offset, data + offset + count);
    };
    const Result<StoredTexture> parsed = parse(fetch, size, name, options);
    if (!parsed) return parsed.error();
    const StoredTexture& stored = *parsed;
    Texture texture = stored.head;
    const int block = format_info(texture.format).block.height;
    for (const StoredTexture::Level& place : stored.levels) {
        Level level{place.extent, std::vector<std::byte>(level_bytes(texture.format, place.extent))};
        const int width = place.extent.width;
        const int rows = blocks_across(place.extent.height, block);
        std::vector<std::byte> inflated;
        if (stored.supercompression != Supercompression::none) {
            inflated.resize(level.bytes.size());
            const auto inflater = LevelInflater::make(stored, fetch, place);
            if (const Result<void> done = inflater->read(place.skipped, inflated); !done) return done.error().of(name);
        }
        const std::byte* source = inflated.empty() ? data + place.offset : inflated.data();
        if (!stored.upwards) {
            convert_rows(stored, source, width, rows, level.bytes.data());
        } else {
            const std::size_t pitch = level_bytes(texture.format, {width, 1});
            for (int j = 0; j < rows; ++j) {
                convert_rows(stored, source + static_cast<std::size_t>(rows - 1 - j) * stored_pitch(stored, width),
                             width, 1, level.bytes.data() + static_cast<std::size_t>(j) * pitch);
            }
        }
        texture.levels.push_back(std::move(level));
    }
    return texture;
}

}  // namespace tex::inline v1
