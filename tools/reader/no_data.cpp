// SPDX-License-Identifier: Apache-2.0
// Reads the tags of GDAL and GeoTIFF in a TIFF that OpenImageIO does not return: GDAL_NODATA (42113), the value of
// texels without data, as text, and GDAL_METADATA (42112), XML with the scale and the offset.

#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include "reader.h"

namespace tex::reader {
namespace {

constexpr std::uint64_t kGdalMetadata = 42112;
constexpr std::uint64_t kGdalNoData = 42113;
constexpr std::uint64_t kGeoTags[] = {33550, 33922, 34264, 34735};  // scale, tie points, transformation, keys
constexpr std::uint64_t kAscii = 2;
constexpr std::uint64_t kMostEntries = 4096;  // of a directory; more are not looked at
constexpr std::uint64_t kMostText = 65536;

// The bytes of the input at `offset`, or fewer if it ends there.
std::string bytes_at(std::uint64_t offset, std::uint64_t count) {
    std::string bytes(count, '\0');
    const auto most = static_cast<std::uint64_t>(std::numeric_limits<off_t>::max());
    if (offset > most) return {};
    const ssize_t n = pread(kInputDescriptor, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    bytes.resize(n > 0 ? static_cast<std::size_t>(n) : 0);
    return bytes;
}

// The first directory of a TIFF, classic or BigTIFF, in either byte order.
class Directory {
public:
    explicit Directory(std::string_view head) {
        big_endian_ = head.starts_with("MM");
        big_tiff_ = number(head, 2, 2) == 43;
        const std::uint64_t at = big_tiff_ ? number(head, 8, 8) : number(head, 4, 4);
        const std::uint64_t size_of_count = big_tiff_ ? 8 : 2;
        const std::uint64_t entries = std::min(number(bytes_at(at, size_of_count), 0, size_of_count), kMostEntries);
        if (at < 8 || at > (std::uint64_t{1} << 62)) return;
        bytes_ = bytes_at(at + size_of_count, entries * entry_bytes());
    }

    // The text of a tag, at most kMostText bytes of it; empty if there is none.
    [[nodiscard]] std::string text(std::uint64_t tag) const {
        const std::uint64_t word = big_tiff_ ? 8 : 4;
        for (std::size_t k = 0; k + entry_bytes() <= bytes_.size(); k += entry_bytes()) {
            const std::string_view entry = std::string_view(bytes_).substr(k, entry_bytes());
            if (number(entry, 0, 2) != tag || number(entry, 2, 2) != kAscii) continue;
            const std::uint64_t count = number(entry, 4, word);
            if (count > kMostText) return {};
            if (count <= word) return std::string(entry.substr(4 + word, count));
            return bytes_at(number(entry, 4 + word, word), count);
        }
        return {};
    }

    [[nodiscard]] bool has(std::uint64_t tag) const {
        for (std::size_t k = 0; k + entry_bytes() <= bytes_.size(); k += entry_bytes()) {
            if (number(std::string_view(bytes_).substr(k, entry_bytes()), 0, 2) == tag) return true;
        }
        return false;
    }

private:
    [[nodiscard]] std::size_t entry_bytes() const { return big_tiff_ ? 20 : 12; }

    // 0 if the bytes are not there.
    [[nodiscard]] std::uint64_t number(std::string_view from, std::size_t at, std::size_t count) const {
        if (from.size() < at + count) return 0;
        std::uint64_t value = 0;
        for (std::size_t k = 0; k < count; ++k) {
            const std::size_t next = big_endian_ ? at + k : at + count - 1 - k;
            value = value << 8 | static_cast<unsigned char>(from[next]);
        }
        return value;
    }

    bool big_endian_ = false;
    bool big_tiff_ = false;
    std::string bytes_;  // the entries
};

// A finite number, with spaces around it.
std::optional<double> number_of(std::string text) {
    text.resize(std::min(text.find('\0'), text.size()));
    const std::size_t first = text.find_first_not_of(" +");
    if (first == std::string::npos) return std::nullopt;
    const char* const end = text.data() + text.find_last_not_of(' ') + 1;
    double value = 0;
    const auto [stop, error] = std::from_chars(text.data() + first, end, value);
    if (error != std::errc() || stop != end || !std::isfinite(value)) return std::nullopt;
    return value;
}

// The number of GDAL's item with this role, for the first sample: <Item name="SCALE" sample="0" role="scale">2</Item>
std::optional<double> item_of(std::string_view metadata, std::string_view role) {
    for (std::size_t at = 0; (at = metadata.find("<Item ", at)) != std::string_view::npos; ++at) {
        const std::size_t close = metadata.find('>', at);
        const std::size_t end = metadata.find('<', close);
        if (end == std::string_view::npos) return std::nullopt;
        const std::string_view tag = metadata.substr(at, close - at);
        const bool is_first = tag.find("sample=") == std::string_view::npos || tag.find("sample=\"0\"") != tag.npos;
        if (is_first && tag.find("role=\"" + std::string(role) + "\"") != tag.npos)
            return number_of(std::string(metadata.substr(close + 1, end - close - 1)));
    }
    return std::nullopt;
}

}  // namespace

void read_tiff_tags(ReaderHeader& header) {
    const Directory directory(bytes_at(0, 16));
    if (const std::optional<double> value = number_of(directory.text(kGdalNoData))) {
        header.has_no_data = 1;
        header.no_data = *value;
    }
    for (const std::uint64_t tag : kGeoTags) {
        if (directory.has(tag)) header.stored.has_place = 1;
    }
    const std::string metadata = directory.text(kGdalMetadata);
    const std::optional<double> scale = item_of(metadata, "scale"), offset = item_of(metadata, "offset");
    header.stored.has_scale = scale || offset ? 1 : 0;
    header.stored.scale = scale.value_or(1.0);
    header.stored.offset = offset.value_or(0.0);
}

}  // namespace tex::reader
