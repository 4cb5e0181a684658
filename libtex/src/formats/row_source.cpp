// SPDX-License-Identifier: Apache-2.0

#include "formats/row_source.h"

#include <algorithm>
#include <string>

#include <tex/pack.h>

#include "blocks/extent.h"
#include "formats/file_types.h"
#include "formats/file_values.h"
#include "formats/ground.h"
#include "formats/normal_mark.h"
#include "formats/size_limits.h"
#include "threads/no_throw.h"

namespace tex::inline v1 {

std::string orientation_text(int orientation, bool is_turned) {
    if (is_turned)
        return "the picture was turned or mirrored, as its orientation (" + std::to_string(orientation) + ") says";
    return "the picture was not turned or mirrored as its orientation (" + std::to_string(orientation) +
           ") says, because PNG is read as it is stored; turn it in an editor, or remove the orientation";
}

std::string trailing_text(std::uint64_t bytes) {
    return std::to_string(bytes) + (bytes == 1 ? " byte beyond its levels was" : " bytes beyond its levels were") +
           " not read";
}

void RowSource::describe(Extent extent, std::vector<std::string> names, std::size_t row_bytes, SampleKind sample,
                         int bits) {
    head_.extent = extent;
    head_.names = std::move(names);
    head_.row_bytes = row_bytes;
    head_.sample = sample;
    head_.bits = bits;
}

void RowSource::describe_mark(std::string mark) {
    head_.strength = strength_in_mark(mark);
    if (!head_.strength) head_.normal_mark = std::move(mark);
}

void RowSource::describe_orientation(int orientation, bool is_turned) {
    head_.orientation = orientation;
    head_.is_turned = is_turned;
    if (orientation != 1) head_.remark = orientation_text(orientation, is_turned);
}

// Stores the last rows of a picture where there is room for whole blocks, and copies them.
static void store_last(const RowSource& source, const std::byte* rows, int first, int count, Image& image) {
    Image last = make_image({image.extent().width, source.held_rows(count)}, image.names);
    source.store(rows, 0, count, last);
    for (std::size_t k = 0; k < image.planes.size(); ++k) {
        for (int j = 0; j < count; ++j)
            std::copy_n(last.planes[k].row(j), image.extent().width, image.planes[k].row(first + j));
    }
}

Result<Image> RowSource::read_all() {
    Image image = make_image(extent(), names());
    image.sample = head_.sample;
    image.bits = head_.bits;
    image.normal_encoding = head_.normal_encoding;
    image.normal_mark = head_.normal_mark;
    image.no_data = head_.no_data;
    image.stored = head_.stored;
    image.scale = head_.scale;
    image.offset = head_.offset;
    image.remark = head_.remark;
    std::vector<std::byte> rows(row_bytes() * static_cast<std::size_t>(rows_together()));
    for (int j = 0; j < extent().height; j += rows_together()) {
        const int count = std::min(rows_together(), extent().height - j);
        if (const Result<void> decoded = decode(j, count, rows.data()); !decoded) return decoded.error();
        if (j + held_rows(count) <= extent().height) {
            store(rows.data(), j, j + count, image);
        } else {
            store_last(*this, rows.data(), j, count, image);
        }
    }
    if (const Result<void> ended = finish(); !ended) return ended.error();
    return image;
}

Result<Image> read_all(Result<std::unique_ptr<RowSource>> rows) {
    return no_throw([&]() -> Result<Image> {
        if (!rows) return rows.error();
        return (*rows)->read_all();
    });
}

Result<void> RowSource::visit(const std::string& name, const TakeRows& take) {
    const int together = rows_together(), held = held_rows(together);
    Image image = make_image({extent().width, held}, names());
    std::vector<std::byte> rows(row_bytes() * static_cast<std::size_t>(held));
    for (int j = 0; j < extent().height; j += together) {
        const int count = std::min(together, extent().height - j);
        if (const Result<void> decoded = decode(j, count, rows.data()); !decoded) return decoded.error().of(name);
        store(rows.data(), 0, count, image);
        if (Result<void> taken = take(image, j, count); !taken) return taken;
    }
    const Result<void> ended = finish();
    return ended ? ended : Result<void>(ended.error().of(name));
}

Result<std::unique_ptr<RowSource>> open_rows(InputFile& file, const ReadOptions& options) {
    const FileType& type = file_type_for(file, options);
    if (const Result<void> fits = check_layer(type, options); !fits) return fits.error().of(file.path());
    if (type.open_rows == nullptr) {
        Result<TextureRows> texture = open_texture_rows(file, options);
        if (!texture) return texture.error();
        return with_values(std::move(texture->levels.front()), options.values);
    }
    Result<std::unique_ptr<RowSource>> rows = type.open_rows(file, options);
    if (!rows) return rows.error().of(file.path());
    return with_values(std::move(*rows), options.values);
}

Result<Image> read_image(InputFile& file, const ReadOptions& options) {
    return no_throw([&]() -> Result<Image> {
        if (file_type_for(file, options).parse != nullptr && options.values != FileValues::stored) {
            const Result<Texture> texture = read_texture(file, options);
            if (!texture) return texture.error();
            return decode(*texture, 0);
        }
        Result<std::unique_ptr<RowSource>> rows = open_rows(file, options);
        if (!rows) return rows.error().of(file.path());
        Result<Image> image = (*rows)->read_all();
        if (!image) return image.error().of(file.path());
        GroundFound found = ground_of(**rows, file);
        image->ground = found.ground;
        image->ground_remark = std::move(found.remark);
        return image;
    });
}

}  // namespace tex::inline v1
