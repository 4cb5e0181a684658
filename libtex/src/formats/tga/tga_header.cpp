// SPDX-License-Identifier: Apache-2.0

#include "formats/tga/tga_header.h"

#include <algorithm>
#include <cstring>

#include "formats/byte_range.h"
#include "formats/bytes.h"
#include "formats/normal_mark.h"
#include "formats/size_limits.h"

namespace tex::inline v1 {
namespace {

// Bits of the descriptor, the last byte of the header.
constexpr int kAlphaBits = 0x0f, kFromRight = 0x10, kFromTop = 0x20, kInterleaved = 0xc0;

// What the extension area says of alpha.
enum class AlphaType { none = 0, ignored = 1 };

// The fields that the rows need, as the file has them.
struct Fields {
    int id_bytes, palette_type, type;
    std::uint32_t palette_first, palette_count;
    int palette_depth, depth, descriptor;
    std::int64_t width, height;
};

Fields fields_of(const std::byte* at) {
    const auto u8 = [at](std::size_t k) { return std::to_integer<int>(at[k]); };
    const auto u16 = [&](std::size_t k) { return u8(k) | u8(k + 1) << 8; };
    return {
        u8(0),  u8(1),   u8(2),  static_cast<std::uint32_t>(u16(3)), static_cast<std::uint32_t>(u16(5)), u8(7), u8(16),
        u8(17), u16(12), u16(14)};
}

int whole_bytes(int depth) { return depth == 15 ? 16 : depth; }

// What is wrong with the fields, or an empty view.
std::string_view refusal(const Fields& fields, TgaTexels texels) {
    const int depth = whole_bytes(fields.depth);
    if ((fields.descriptor & kInterleaved) != 0) return "a TGA with interleaved rows";
    switch (texels) {
        case TgaTexels::indices: return depth > 16 ? "a TGA with indices of more than 16 bits" : "";
        case TgaTexels::grey: return depth > 16 ? "a grey TGA of more than 16 bits" : "";
        case TgaTexels::color: break;
    }
    return depth == 8 ? "a TGA with colours of 8 bits" : "";
}

Result<void> read_palette(const InputFile& file, const Fields& fields, TgaHeader& header) {
    const int depth = whole_bytes(fields.palette_depth);
    const auto entry = static_cast<std::size_t>(depth / 8);
    ByteRange bytes(file, header.first, *file.size());
    header.index_0 = fields.palette_first;
    if (header.texels == TgaTexels::indices) header.palette.reserve(fields.palette_count);
    for (std::uint32_t k = 0; k < fields.palette_count; ++k) {
        const std::byte* const stored = bytes.take(entry);
        if (stored == nullptr) return bytes.error();
        if (header.texels == TgaTexels::indices) header.palette.push_back(tga_color(stored, depth));
    }
    header.first = bytes.position();
    return {};
}

// The extension area that the footer names, or nothing.
Result<std::vector<std::byte>> read_extension(const InputFile& file) {
    std::vector<std::byte> area;
    const std::int64_t size = *file.size();
    std::byte footer[kTgaFooter];
    if (size < static_cast<std::int64_t>(kTgaHeader + kTgaFooter)) return area;
    const auto read = [&](std::int64_t at, std::byte* to, std::size_t count) -> Result<bool> {
        const Result<std::size_t> got = file.read_at(at, to, count);
        if (!got) return got.error();
        return *got == count;
    };
    const Result<bool> got = read(size - static_cast<std::int64_t>(kTgaFooter), footer, kTgaFooter);
    if (!got) return got.error();
    // Some programs end the signature without its dot or its zero.
    constexpr std::size_t kSignificant = 16;
    const std::int64_t place = load_u32(footer);
    if (!*got || std::memcmp(footer + 8, kTgaSignature.data(), kSignificant) != 0 || place == 0) return area;
    area.resize(kTgaExtension);
    const Result<bool> there = read(place, area.data(), area.size());
    if (!there) return there.error();
    const auto claimed = static_cast<std::size_t>(load_u32(area.data()) & 0xffff);
    if (!*there || claimed < kTgaExtension) area.clear();
    return area;
}

// Whether texels, or colours of the palette, have a channel of alpha.
bool has_alpha(const Fields& fields, TgaTexels texels, const std::vector<std::byte>& extension) {
    const bool is_counted = (fields.descriptor & kAlphaBits) == 8;
    if (!extension.empty()) {
        const auto type = static_cast<AlphaType>(extension[kTgaAlphaType]);
        if (type == AlphaType::ignored || (type == AlphaType::none && !is_counted)) return false;
    }
    switch (texels) {
        case TgaTexels::indices: return fields.palette_depth == 32 && is_counted;
        case TgaTexels::grey: return fields.depth == 16 && is_counted;
        case TgaTexels::color: break;
    }
    return fields.depth == 32;  // many programs do not count the bits
}

// Whether nothing says what the second byte of a grey texel is. Programs read two numbers, or one of 16 bits.
bool has_unknown_byte(const Fields& fields, TgaTexels texels, const std::vector<std::byte>& extension) {
    const bool is_told = !extension.empty() && static_cast<AlphaType>(extension[kTgaAlphaType]) != AlphaType::none;
    return texels == TgaTexels::grey && fields.depth == 16 && (fields.descriptor & kAlphaBits) == 0 && !is_told;
}

void take_mark(const std::vector<std::byte>& extension, TgaHeader& header) {
    if (extension.empty()) return;
    for (std::size_t line = 0; line < 4 && header.normal_mark.empty(); ++line) {
        const auto* text = reinterpret_cast<const char*>(extension.data()) + kTgaComments + line * kTgaCommentLine;
        header.normal_mark = mark_in_description({text, strnlen(text, kTgaCommentLine)});
    }
}

}  // namespace

Result<TgaHeader> read_tga_header(const InputFile& file, const ReadOptions& options) {
    const Fields fields = fields_of(file.head().data());
    TgaHeader header;
    constexpr int kRle = 8;
    const int type = fields.type & ~kRle;
    header.texels = type == 1 ? TgaTexels::indices : type == 2 ? TgaTexels::color : TgaTexels::grey;
    header.is_rle = (fields.type & kRle) != 0;
    const bool has_palette = fields.palette_type == 1;
    if (header.texels == TgaTexels::indices && !has_palette)
        return Error{ErrorCode::bad_data, file.path(), "damaged: a picture of indices without a palette"};
    if (const std::string_view reason = refusal(fields, header.texels); !reason.empty())
        return Error{ErrorCode::unsupported, file.path(), std::string(reason)};
    const Result<Extent> extent = claimed_extent(file.path(), fields.width, fields.height, options);
    if (!extent) return extent.error();
    header.extent = *extent;
    header.depth = whole_bytes(fields.depth);
    header.from_top = (fields.descriptor & kFromTop) != 0;
    header.from_right = (fields.descriptor & kFromRight) != 0;
    header.first = static_cast<std::int64_t>(kTgaHeader) + fields.id_bytes;
    if (has_palette) {
        if (const Result<void> read = read_palette(file, fields, header); !read) return read.error();
    }
    const Result<std::vector<std::byte>> extension = read_extension(file);
    if (!extension) return extension.error();
    if (has_unknown_byte(fields, header.texels, *extension)) {
        return Error{
            ErrorCode::unsupported, file.path(),
            "a grey TGA of 16 bits that counts no bits of alpha: its texels are grey and alpha, or one number"};
    }
    const int color_depth = header.texels == TgaTexels::indices ? whole_bytes(fields.palette_depth) : header.depth;
    header.bits = header.texels != TgaTexels::grey && color_depth == 16 ? 5 : 8;
    header.channels =
        (header.texels == TgaTexels::grey ? 1 : 3) + (has_alpha(fields, header.texels, *extension) ? 1 : 0);
    take_mark(*extension, header);
    return header;
}

}  // namespace tex::inline v1
