// SPDX-License-Identifier: Apache-2.0

#include "formats/bmp/bmp.h"

#include <cstdint>
#include <utility>
#include <vector>

#include "formats/bmp/bmp_header.h"
#include "formats/bottom_up.h"
#include "formats/bytes.h"
#include "formats/file_types.h"
#include "threads/no_throw.h"

namespace tex::inline v1 {
namespace {

constexpr std::size_t kAlignment = 4;
constexpr std::uint32_t kGreys = 256;

std::vector<std::byte> headers_of(const TextureHead& head, std::uint64_t texels) {
    const bool is_grey = format_info(head.format).channels == 1;
    const std::uint32_t colors = is_grey ? kGreys : 0;
    const auto first = static_cast<std::uint32_t>(kBmpFileHeader + kBmpInfoHeader + 4 * colors);
    ByteWriter bytes;
    bytes.text(kBmpMagic);
    bytes.u32(first + static_cast<std::uint32_t>(texels));
    bytes.zeros(4);
    bytes.u32(first);
    bytes.u32(kBmpInfoHeader);
    bytes.u32(static_cast<std::uint32_t>(head.extent.width));
    bytes.u32(static_cast<std::uint32_t>(head.extent.height));
    bytes.u32(1u | (is_grey ? 8u : 24u) << 16);  // one plane; the depth
    bytes.u32(0);                                // no compression
    bytes.u32(static_cast<std::uint32_t>(texels));
    bytes.zeros(8);  // no resolution
    bytes.u32(colors);
    bytes.u32(colors);
    for (std::uint32_t k = 0; k < colors; ++k) bytes.u32(k << 16 | k << 8 | k);
    return bytes.take();
}

}  // namespace

Result<std::unique_ptr<RowTarget>> open_bmp_target(const TextureHead& head, WriteBytes write) {
    return no_throw([&]() -> Result<std::unique_ptr<RowTarget>> {
        const Result<void> held = check_holds(file_type_of(Container::bmp), head.format, {});
        if (!held) return held.error();
        const std::size_t row = level_bytes(head.format, {head.extent.width, 1});
        const std::uint64_t texels =
            (row + kAlignment - 1) / kAlignment * kAlignment * static_cast<std::uint64_t>(head.extent.height);
        constexpr std::uint64_t kHeaders = 2048;  // at most
        if (texels + kHeaders > UINT32_MAX) return Error{ErrorCode::unsupported, {}, "a BMP has at most 4 GiB"};
        return open_bottom_up({head.format, head.extent, headers_of(head, texels), kAlignment, {}}, std::move(write));
    });
}

}  // namespace tex::inline v1
