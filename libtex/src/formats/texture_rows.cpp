// SPDX-License-Identifier: Apache-2.0

#include "formats/texture_rows.h"

#include <algorithm>
#include <utility>

#include <tex/file.h>

#include "formats/file_types.h"
#include "formats/level_rows.h"
#include "formats/normal_mark.h"
#include "formats/picture.h"
#include "threads/no_throw.h"

namespace tex::inline v1 {
namespace {

// A picture as a texture of one level, read by rows.
Result<TextureRows> picture_rows(const InputFile& file, Result<std::unique_ptr<RowSource>> rows) {
    if (!rows) return rows.error().of(file.path());
    const PictureHead& head = (*rows)->head();
    Result<PictureTexture> picture = picture_texture_of(head.names, head.sample, head.bits);
    if (!picture) {  // a damaged picture is reported as damaged first
        const Result<Image> image = (*rows)->read_all();
        return (image ? picture.error() : image.error()).of(file.path());
    }
    TextureRows texture;
    texture.head = std::move(picture->head);
    texture.head.normal_encoding = head.normal_encoding;
    texture.head.orientation = head.orientation;
    texture.head.turned = head.is_turned;
    if (!head.absent.empty()) texture.head.remarks.push_back(head.absent);
    (*rows)->keep_masked();
    if (head.is_multiplied) texture.head.remarks.emplace_back(kMultipliedText);
    apply_found_mark(head.normal_mark, texture.head);
    texture.levels.push_back(std::move(*rows));
    texture.planes = std::move(picture->planes);
    texture.rounds = picture->rounds;
    return texture;
}

// Refuses a file that is too large to be read. What its header claims says more than its size in bytes.
Result<void> check_size(InputFile& file, const FileType& type, const ReadOptions& options) {
    if (!file.size() || *file.size() <= largest_file(options)) return {};
    const auto size = static_cast<std::size_t>(*file.size());
    const Result<StoredTexture> claimed = type.parse(fetch_from(file), size, file.path(), options);
    if (!claimed) return claimed.error();
    return file.read_rest(largest_file(options)).error();
}

// The levels of a file that stores their texels unchanged.
Result<TextureRows> stored_rows(InputFile& file, const FileType& type, const ReadOptions& options) {
    if (const Result<void> settled = file.settle(largest_file(options)); !settled) return settled.error();
    if (const Result<void> fits = check_size(file, type, options); !fits) return fits.error();
    Result<StoredTexture> parsed =
        type.parse(fetch_from(file), static_cast<std::size_t>(*file.size()), file.path(), options);
    if (!parsed) return parsed.error();
    const auto stored = std::make_shared<const StoredTexture>(std::move(*parsed));
    TextureRows texture;
    texture.head = stored->head;
    for (std::size_t k = 0; k < stored->levels.size(); ++k) texture.levels.push_back(open_level_rows(file, stored, k));
    texture.take_planes_in_order();
    return texture;
}

Result<TextureRows> open_any(InputFile& file, const FileType& type, const ReadOptions& options) {
    if (const Result<void> fits = check_layer(type, options); !fits) return fits.error().of(file.path());
    if (type.parse != nullptr) return stored_rows(file, type, options);
    if (type.open_levels != nullptr) {
        Result<TextureRows> texture = type.open_levels(file, options);
        if (!texture) return texture.error().of(file.path());
        return texture;
    }
    if (type.reader_name != nullptr) {  // so that the file can be read a second time
        const Result<void> settled = file.settle(std::min(largest_file(options), options.reader_memory));
        if (!settled) return settled.error();
    }
    return picture_rows(file, type.open_rows(file, options));
}

}  // namespace

Result<Texture> read_all(Result<TextureRows> rows) {
    return no_throw([&]() -> Result<Texture> {
        if (!rows) return rows.error();
        Texture texture = std::move(rows->head);
        for (const std::unique_ptr<RowSource>& rows_of : rows->levels) {
            Level level{rows_of->extent(), std::vector<std::byte>(level_bytes(texture.format, rows_of->extent()))};
            const std::size_t row_bytes = level.bytes.size() / static_cast<std::size_t>(level.extent.height);
            const auto take = [&](const Image& image, int first, int count) -> Result<void> {
                store_texels(image, count, texture.format, rows->planes,
                             level.bytes.data() + static_cast<std::size_t>(first) * row_bytes);
                return {};
            };
            if (const Result<void> read = rows_of->visit({}, take); !read) return read.error();
            texture.levels.push_back(std::move(level));
        }
        return texture;
    });
}

Result<Texture> read_texture(InputFile& file, const ReadOptions& options) {
    return no_throw([&]() -> Result<Texture> {
        const FileType& type = file_type_for(file, options);
        if (const Result<void> fits = check_layer(type, options); !fits) return fits.error().of(file.path());
        if (type.parse != nullptr) {
            if (const Result<void> fits = check_size(file, type, options); !fits) return fits.error();
            const Result<std::vector<std::byte>> bytes = file.read_rest(largest_file(options));
            if (!bytes) return bytes.error();
            return load_texture(type.parse, bytes->data(), bytes->size(), file.path(), options);
        }
        if (type.open_levels != nullptr) {
            Result<Texture> texture = read_all(type.open_levels(file, options));
            if (!texture) return texture.error().of(file.path());
            return texture;
        }
        Result<Texture> texture = read_all(picture_rows(file, type.open_rows(file, options)));
        if (!texture) return texture.error().of(file.path());
        return texture;
    });
}

Result<TextureRows> open_texture_rows(InputFile& file, const ReadOptions& options) {
    return no_throw([&]() -> Result<TextureRows> { return open_any(file, file_type_for(file, options), options); });
}

}  // namespace tex::inline v1
