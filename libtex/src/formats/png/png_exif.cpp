// SPDX-License-Identifier: Apache-2.0

#include "formats/png/png_exif.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#include <libdeflate.h>

#include "formats/bytes.h"
#include "formats/exif.h"

namespace tex::inline v1 {

int png_orientation(std::string_view content) {
    if (content.starts_with(kExifMark)) content.remove_prefix(kExifMark.size());  // some writers keep it
    const std::uint32_t orientation = exif_orientation(content);
    return orientation >= 1 && orientation <= 8 ? static_cast<int>(orientation) : 1;
}

Result<int> png_orientation_at_end(const InputFile& file) {
    constexpr std::string_view kType = "eXIf";
    constexpr std::int64_t kEnd = 65536;
    constexpr std::size_t kNumber = 4;
    const std::int64_t count = std::min(kEnd, *file.size());
    std::vector<std::byte> bytes(static_cast<std::size_t>(count));
    const Result<std::size_t> got = file.read_at(*file.size() - count, bytes.data(), bytes.size());
    if (!got) return got.error();
    const std::string_view end(reinterpret_cast<const char*>(bytes.data()), *got);
    // The CRC tells a chunk from texels that look like its type.
    for (std::size_t at = end.find(kType, kNumber); at != std::string_view::npos; at = end.find(kType, at + 1)) {
        const std::size_t length = load_big_u32(bytes.data() + at - kNumber), content = at + kType.size();
        if (end.size() - content < kNumber || length > end.size() - content - kNumber) continue;
        const std::uint32_t crc = libdeflate_crc32(0, bytes.data() + at, kType.size() + length);
        if (crc == load_big_u32(bytes.data() + content + length)) return png_orientation(end.substr(content, length));
    }
    return 1;
}

}  // namespace tex::inline v1
