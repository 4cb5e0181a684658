// SPDX-License-Identifier: Apache-2.0

#include "formats/bmp/bmp_header.h"

#include <algorithm>
#include <bit>
#include <string>

#include "formats/byte_range.h"
#include "formats/bytes.h"
#include "formats/size_limits.h"

namespace tex::inline v1 {
namespace {

enum class Compression : std::uint32_t { none, rle8, rle4, masks, jpeg, png, masks_with_alpha };

constexpr std::uint32_t kInfo2 = 52, kInfo3 = 56, kOs2 = 64, kV4 = 108, kV5 = 124;
constexpr std::size_t kMasks = 40;  // of four bytes each: the header's own, or what follows a header of 40 bytes

// The bytes after the file header.
struct Fields {
    std::uint32_t header_bytes = 0;
    std::int64_t width = 0, height = 0;
    int depth = 0;
    Compression compression = Compression::none;
    std::uint32_t colors = 0;
    std::array<std::uint32_t, 4> masks{};  // R, G, B, A
    std::size_t size = 0;                  // of the header and of masks that follow it
};

Error damaged(const InputFile& file, const std::string& what) {
    return {ErrorCode::bad_data, file.path(), "damaged: " + what};
}

Error unsupported(const InputFile& file, const std::string& what) {
    return {ErrorCode::unsupported, file.path(), what};
}

bool is_known_size(std::uint32_t bytes) {
    constexpr std::uint32_t kSizes[] = {kBmpCoreHeader, kBmpInfoHeader, kInfo2, kInfo3, kOs2, kV4, kV5};
    return std::find(std::begin(kSizes), std::end(kSizes), bytes) != std::end(kSizes);
}

int load_u16(const std::byte* at) { return std::to_integer<int>(at[0]) | std::to_integer<int>(at[1]) << 8; }

Result<Fields> read_fields(const InputFile& file) {
    ByteRange bytes(file, static_cast<std::int64_t>(kBmpFileHeader), *file.size());
    const std::byte* const size = bytes.take(4);
    if (size == nullptr) return bytes.error();
    Fields fields;
    fields.header_bytes = load_u32(size);
    if (!is_known_size(fields.header_bytes))
        return unsupported(file, "a BMP with a header of " + std::to_string(fields.header_bytes) + " bytes");
    const std::byte* at = bytes.take(fields.header_bytes - 4);
    if (at == nullptr) return bytes.error();
    at -= 4;  // where the header begins, for the offsets of the specification
    fields.size = fields.header_bytes;
    if (fields.header_bytes == kBmpCoreHeader) {
        fields.width = load_u16(at + 4);
        fields.height = load_u16(at + 6);
        fields.depth = load_u16(at + 10);
        return fields;
    }
    fields.width = static_cast<std::int32_t>(load_u32(at + 4));
    fields.height = static_cast<std::int32_t>(load_u32(at + 8));
    fields.depth = load_u16(at + 14);
    fields.compression = static_cast<Compression>(load_u32(at + 16));
    fields.colors = load_u32(at + 32);
    const bool has_masks =
        fields.compression == Compression::masks || fields.compression == Compression::masks_with_alpha;
    if (!has_masks || fields.header_bytes == kOs2) return fields;
    std::size_t count = fields.header_bytes == kInfo2 ? 3 : 4;
    if (fields.header_bytes == kBmpInfoHeader) {
        count = fields.compression == Compression::masks ? 3 : 4;
        at = bytes.take(4 * count);
        if (at == nullptr) return bytes.error();
        fields.size += 4 * count;
    } else {
        at += kMasks;
    }
    for (std::size_t c = 0; c < count; ++c) fields.masks[c] = load_u32(at + 4 * c);
    return fields;
}

// What cannot be read, or an empty view.
std::string_view refusal(const Fields& fields) {
    if (fields.header_bytes == kOs2 && fields.compression == Compression::masks) return "a BMP with Huffman codes";
    if (fields.header_bytes == kOs2 && fields.compression == Compression::jpeg) return "a BMP with RLE of 24 bits";
    switch (fields.compression) {
        case Compression::jpeg: return "a JPEG in a BMP";
        case Compression::png: return "a PNG in a BMP";
        case Compression::none:
        case Compression::rle8:
        case Compression::rle4:
        case Compression::masks:
        case Compression::masks_with_alpha: break;
        default: return "a BMP with an unknown compression";
    }
    for (const int depth : {1, 2, 4, 8, 16, 24, 32}) {
        if (fields.depth == depth) return {};
    }
    return "a BMP with a depth that does not exist";
}

Result<void> check_compression(const InputFile& file, const Fields& fields) {
    const bool rle8 = fields.compression == Compression::rle8, rle4 = fields.compression == Compression::rle4;
    if ((rle8 && fields.depth != 8) || (rle4 && fields.depth != 4)) return damaged(file, "RLE of another depth");
    if ((rle8 || rle4) && fields.height < 0) return damaged(file, "RLE with rows from the top");
    if (fields.masks != std::array<std::uint32_t, 4>{} && fields.depth != 16 && fields.depth != 32)
        return damaged(file, "masks for texels of " + std::to_string(fields.depth) + " bits");
    return {};
}

Result<void> read_palette(const InputFile& file, const Fields& fields, BmpHeader& header) {
    const std::size_t entry = fields.header_bytes == kBmpCoreHeader ? 3 : 4;
    const std::uint32_t most = 1u << header.depth;
    const std::uint32_t count = fields.colors == 0 ? most : std::min(fields.colors, most);
    ByteRange bytes(file, static_cast<std::int64_t>(kBmpFileHeader + fields.size), *file.size());
    header.is_grey = true;
    for (std::uint32_t k = 0; k < count; ++k) {
        const std::byte* const color = bytes.take(entry);
        if (color == nullptr) return bytes.error();
        const auto code = [color](std::size_t c) { return std::to_integer<std::uint8_t>(color[c]); };
        header.palette.push_back({code(2), code(1), code(0)});
        header.is_grey = header.is_grey && code(0) == code(1) && code(1) == code(2);
    }
    return {};
}

// The fields of the masks, or those of a file without masks.
Result<void> find_fields(const InputFile& file, Fields fields, BmpHeader& header) {
    std::array<std::uint32_t, 4>& masks = fields.masks;
    if (masks == std::array<std::uint32_t, 4>{}) {
        masks = {0xff0000, 0xff00, 0xff, 0};
        if (header.depth == 16) masks = {0x7c00, 0x3e0, 0x1f, 0};
    }
    for (std::size_t c = 0; c < (masks[3] == 0 ? 3 : 4); ++c) {
        BmpField field{std::countr_zero(masks[c]), std::popcount(masks[c])};
        const std::uint64_t bits = (std::uint64_t{1} << field.bits) - 1;
        if (masks[c] == 0 || bits << field.shift != masks[c]) return damaged(file, "a mask that is no run of bits");
        constexpr int kMostBits = 16;
        if (field.bits > kMostBits) {
            field.shift += field.bits - kMostBits;
            field.bits = kMostBits;
        }
        header.fields.push_back(field);
    }
    header.bits = 0;
    for (const BmpField& field : header.fields) header.bits = std::max(header.bits, field.bits);
    const bool divides = std::all_of(header.fields.begin(), header.fields.end(),
                                     [&](const BmpField& field) { return header.bits % field.bits == 0; });
    if (!divides) header.bits = header.bits > 8 ? 16 : 8;
    return {};
}

}  // namespace

Result<BmpHeader> read_bmp_header(const InputFile& file, const ReadOptions& options) {
    const Result<Fields> fields = read_fields(file);
    if (!fields) return fields.error();
    if (const std::string_view reason = refusal(*fields); !reason.empty())
        return unsupported(file, std::string(reason));
    if (const Result<void> sound = check_compression(file, *fields); !sound) return sound.error();
    const std::int64_t height = fields->height < 0 ? -fields->height : fields->height;
    const Result<Extent> extent = claimed_extent(file.path(), fields->width, height, options);
    if (!extent) return extent.error();
    BmpHeader header;
    header.extent = *extent;
    header.from_top = fields->height < 0;
    header.is_rle = fields->compression == Compression::rle8 || fields->compression == Compression::rle4;
    header.depth = fields->depth;
    constexpr std::size_t kPlace = 10;  // of the offset of the texels, in the file header
    header.first = load_u32(file.head().data() + kPlace);
    if (header.first < static_cast<std::int64_t>(kBmpFileHeader + fields->size))
        return damaged(file, "the texels begin within the header");
    constexpr int kMostIndexed = 8;
    const Result<void> read =
        header.depth <= kMostIndexed ? read_palette(file, *fields, header) : find_fields(file, *fields, header);
    if (!read) return read.error();
    return header;
}

}  // namespace tex::inline v1
