// SPDX-License-Identifier: Apache-2.0

#include "formats/texture_rows.h"

#include <algorithm>
#include <utility>

#include <tex/container.h>

#include "formats/dds/dds.h"
#include "formats/exr/exr.h"
#include "formats/exr/exr_rows.h"
#include "formats/ktx2/ktx2.h"
#include "formats/level_rows.h"
#include "formats/picture.h"
#include "formats/png/png.h"
#include "formats/reader/reader.h"
#include "formats/reader/reader_rows.h"
#include "threads/guard.h"

namespace tex {
namespace {

bool is_texture(const InputFile& file) {
    return is_dds(file.head().data(), file.head().size()) || is_ktx2(file.head().data(), file.head().size());
}

using Opened = Result<std::optional<TextureRows>>;

// A picture, from its rows.
Opened picture_rows(const InputFile& file, Result<std::unique_ptr<RowSource>> rows) {
    if (!rows) return rows.error().of(file.path());
    Result<PictureTexture> picture = picture_texture_of((*rows)->names(), (*rows)->sample(), (*rows)->bits());
    // What is wrong with a picture shows when it has been read.
    if (!picture || !(*rows)->is_sequential()) return std::optional<TextureRows>();
    TextureRows texture;
    texture.head = std::move(picture->head);
    texture.levels.push_back(std::move(*rows));
    texture.planes = std::move(picture->planes);
    texture.rounds = picture->rounds;
    return std::optional(std::move(texture));
}

// The levels of a DDS or KTX2 file.
Opened level_rows(InputFile& file, const ReadOptions& options) {
    if (const Result<void> settled = file.settle(largest_file(options)); !settled) return settled.error();
    if (*file.size() > largest_file(options)) return std::optional<TextureRows>();  // read_texture() says so
    const FetchBytes fetch = [&file](std::uint64_t offset, std::size_t count) -> Result<std::vector<std::byte>> {
        std::vector<std::byte> bytes(count);
        const Result<std::size_t> got = file.read_at(static_cast<std::int64_t>(offset), bytes.data(), count);
        if (!got) return got.error();
        if (*got < count) return Error{ErrorCode::bad_data, file.path(), "the file ends too early"};
        return bytes;
    };
    const auto parse = is_dds(file.head().data(), file.head().size()) ? parse_dds : parse_ktx2;
    Result<StoredTexture> parsed = parse(fetch, static_cast<std::size_t>(*file.size()), file.path(), options);
    if (!parsed) return parsed.error();
    const auto stored = std::make_shared<const StoredTexture>(std::move(*parsed));
    TextureRows texture;
    texture.head = stored->head;
    for (std::size_t k = 0; k < stored->levels.size(); ++k) texture.levels.push_back(open_level_rows(file, stored, k));
    for (int c = 0; c < format_info(stored->head.format).channels; ++c)
        texture.planes.push_back(static_cast<std::size_t>(c));
    return std::optional(std::move(texture));
}

Opened exr_rows(InputFile& file, const ReadOptions& options) {
    Result<ExrTextureRows> rows = open_exr_texture_rows(file, options);
    if (!rows) return rows.error().of(file.path());
    TextureRows texture;
    texture.head = std::move(rows->head);
    texture.levels = std::move(rows->levels);
    for (std::size_t c = 0; c < texture.levels.front()->names().size(); ++c) texture.planes.push_back(c);
    return std::optional(std::move(texture));
}

}  // namespace

Result<Texture> read_texture(InputFile& file, const ReadOptions& options) {
    return guarded([&]() -> Result<Texture> {
        if (is_texture(file)) {
            const Result<std::vector<std::byte>> bytes = file.read_rest(largest_file(options));
            if (!bytes) return bytes.error();
            return decode_file(bytes->data(), bytes->size(), file.path(), options);
        }
        if (is_exr(file.head())) return read_exr_texture(file, options);
        const Result<Image> image = is_png(file.head()) ? read_png(file, options) : read_with_reader(file, options);
        if (!image) return image.error();
        Result<Texture> texture = texture_of(*image);
        if (!texture) return texture.error().of(file.path());
        return texture;
    });
}

Opened open_texture_rows(InputFile& file, const ReadOptions& options) {
    return guarded([&]() -> Opened {
        if (is_texture(file)) return level_rows(file, options);
        if (is_exr(file.head())) return exr_rows(file, options);
        if (!is_png(file.head())) {  // so that it can be read once more
            const Result<void> settled = file.settle(std::min(largest_file(options), options.reader_memory));
            if (!settled) return settled.error();
        }
        Opened rows =
            picture_rows(file, is_png(file.head()) ? open_png(file, options) : open_reader_rows(file, options));
        if (rows && !*rows) {
            if (const Result<void> again = file.rewind(); !again) return again.error();
        }
        return rows;
    });
}

}  // namespace tex
