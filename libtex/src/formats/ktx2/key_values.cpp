// SPDX-License-Identifier: Apache-2.0

#include "formats/ktx2/key_values.h"

#include <algorithm>

#include "formats/bytes.h"

namespace tex::inline v1 {

std::optional<std::vector<KeyValue>> parse_key_values(const std::vector<std::byte>& bytes, bool big_endian) {
    std::vector<KeyValue> entries;
    const std::byte* data = bytes.data();
    std::size_t size = bytes.size();
    while (size >= 4) {
        const std::size_t length = big_endian ? load_big_u32(data) : load_u32(data);
        if (length > size - 4) return std::nullopt;
        const std::string_view entry(reinterpret_cast<const char*>(data + 4), length);
        const std::size_t end = entry.find('\0');
        if (end == std::string_view::npos) return std::nullopt;
        std::string_view value = entry.substr(end + 1);
        if (!value.empty() && value.back() == '\0') value.remove_suffix(1);
        entries.push_back({entry.substr(0, end), value});
        const std::size_t step = std::min(size, (length + 7) & ~std::size_t{3});
        data += step;
        size -= step;
    }
    return entries;
}

}  // namespace tex::inline v1
