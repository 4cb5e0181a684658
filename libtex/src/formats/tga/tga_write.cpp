// SPDX-License-Identifier: Apache-2.0

#include "formats/tga/tga.h"

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "formats/bottom_up.h"
#include "formats/bytes.h"
#include "formats/file_types.h"
#include "formats/normal_mark.h"
#include "formats/tga/tga_header.h"
#include "threads/no_throw.h"

namespace tex::inline v1 {
namespace {

constexpr int kMostSide = 65535;

void put_u16(ByteWriter& bytes, int value) {
    bytes.u8(static_cast<std::uint32_t>(value) & 0xff);
    bytes.u8(static_cast<std::uint32_t>(value) >> 8);
}

std::vector<std::byte> header_of(const TextureHead& head) {
    const int channels = format_info(head.format).channels;
    ByteWriter bytes;
    bytes.zeros(2);                   // no text, no palette
    bytes.u8(channels == 1 ? 3 : 2);  // grey, or colour
    bytes.zeros(9);                   // the palette, the origin
    put_u16(bytes, head.extent.width);
    put_u16(bytes, head.extent.height);
    bytes.u8(static_cast<std::uint32_t>(8 * channels));
    bytes.u8(channels == 4 ? 8 : 0);  // bits of alpha; rows from the bottom
    return bytes.take();
}

// The extension area and the footer, which begin at `place`.
std::vector<std::byte> trailer_of(const TextureHead& head, std::uint64_t place) {
    constexpr std::size_t kVersionLetter = 428;
    const std::string comment = description_of(normal_mark(head));
    const bool has_alpha = format_info(head.format).channels == 4;
    constexpr int kNoAlpha = 0, kUsefulAlpha = 3;
    ByteWriter bytes;
    put_u16(bytes, static_cast<int>(kTgaExtension));
    bytes.zeros(kTgaComments - bytes.size());
    bytes.text(comment);
    bytes.zeros(kVersionLetter - bytes.size());
    bytes.text(" ");
    bytes.zeros(kTgaAlphaType - bytes.size());
    bytes.u8(has_alpha ? kUsefulAlpha : kNoAlpha);
    bytes.u32(static_cast<std::uint32_t>(place));
    bytes.zeros(4);  // no developer area
    bytes.text(kTgaSignature);
    return bytes.take();
}

}  // namespace

Result<std::unique_ptr<RowTarget>> open_tga_target(const TextureHead& head, WriteBytes write) {
    return no_throw([&]() -> Result<std::unique_ptr<RowTarget>> {
        const Result<void> held = check_holds(file_type_of(Container::tga), head.format, {});
        if (!held) return held.error();
        if (head.extent.width > kMostSide || head.extent.height > kMostSide)
            return Error{ErrorCode::unsupported, {}, "a side of a TGA has at most 65535 texels"};
        const std::uint64_t place = kTgaHeader + level_bytes(head.format, head.extent);
        if (place > UINT32_MAX) return Error{ErrorCode::unsupported, {}, "a TGA has at most 4 GiB"};
        BottomUpFile file{head.format, head.extent, header_of(head), 1, trailer_of(head, place)};
        return open_bottom_up(std::move(file), std::move(write));
    });
}

}  // namespace tex::inline v1
