// SPDX-License-Identifier: Apache-2.0

#include "formats/astc/astc_file.h"

#include <cstdint>
#include <optional>
#include <utility>

#include "formats/bytes.h"
#include "formats/channels.h"
#include "formats/size_limits.h"
#include "rows/codecs.h"

namespace tex::inline v1 {
namespace {

constexpr std::size_t kHeaderBytes = 16;

Error bad_data(const std::string& name, std::string reason) { return {ErrorCode::bad_data, name, std::move(reason)}; }

std::optional<Format> format_of_blocks(int width, int height) {
    for (const Named<Format>& row : kFormatNames) {
        if (holds_astc(row.value) && format_info(row.value).block == Extent{width, height}) return row.value;
    }
    return std::nullopt;
}

void write_side(ByteWriter& writer, int texels) {
    for (int shift = 0; shift < 24; shift += 8) writer.u8(static_cast<std::uint32_t>(texels) >> shift);
}

}  // namespace

bool holds_astc(Format format) { return format_row(format).codec->khr_model == kKhrAstc; }

FileLayout astc_layout(const TextureHead& head, const WriteOptions&) {
    const Extent block = format_info(head.format).block;
    FileLayout layout;
    layout.levels = {{kHeaderBytes, level_bytes(head.format, head.extent)}};
    layout.size = kHeaderBytes + layout.levels.front().bytes;
    ByteWriter writer;
    writer.text(kAstcMagic);
    writer.u8(static_cast<std::uint32_t>(block.width));
    writer.u8(static_cast<std::uint32_t>(block.height));
    writer.u8(1);
    write_side(writer, head.extent.width);
    write_side(writer, head.extent.height);
    write_side(writer, 1);
    layout.head = writer.take();
    return layout;
}

Result<StoredTexture> parse_astc(const FetchBytes& fetch, std::size_t size, const std::string& name,
                                 const ReadOptions& options) {
    if (size < kHeaderBytes) return bad_data(name, "truncated: the ASTC header is not complete");
    const Result<std::vector<std::byte>> head = fetch(0, kHeaderBytes);
    if (!head) return head.error();
    const auto byte = [&](std::size_t k) { return std::to_integer<int>((*head)[k]); };
    const auto side = [&](std::size_t k) { return byte(k) | byte(k + 1) << 8 | byte(k + 2) << 16; };
    if (byte(6) > 1 || side(13) > 1) return Error{ErrorCode::unsupported, name, "volume textures are not supported"};
    const std::optional<Format> format = format_of_blocks(byte(4), byte(5));
    if (!format) {
        return bad_data(name, "blocks of " + std::to_string(byte(4)) + "x" + std::to_string(byte(5)) +
                                  " texels, which ASTC does not have");
    }
    const Result<Extent> extent = claimed_extent(name, side(7), side(10), options);
    if (!extent) return extent.error();
    const std::size_t bytes = level_bytes(*format, *extent);
    const std::size_t left = size - kHeaderBytes;
    if (bytes > left) {
        return bad_data(name, "truncated: the blocks want " + std::to_string(bytes) + " bytes, " +
                                  std::to_string(left) + " are left");
    }
    StoredTexture stored;
    stored.head.format = *format;
    stored.head.swizzle = likely_swizzle(*format);
    stored.head.trailing_bytes = left - bytes;
    stored.levels = {{*extent, kHeaderBytes, bytes}};
    return stored;
}

}  // namespace tex::inline v1
