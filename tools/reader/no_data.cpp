// SPDX-License-Identifier: Apache-2.0
// Reads GDAL's tag GDAL_NODATA (42113) of a TIFF: the value of texels without data, as text. OpenImageIO does not
// return this tag.

#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <string_view>

#include "reader.h"

namespace tex::reader {
namespace {

constexpr std::uint64_t kTag = 42113;
constexpr std::uint64_t kAscii = 2;
constexpr std::uint64_t kMostEntries = 4096;  // of a directory; more are not looked at
constexpr std::uint64_t kMostText = 64;

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

}  // namespace

std::optional<double> tiff_no_data() {
    std::string text = Directory(bytes_at(0, 16)).text(kTag);
    text.resize(std::min(text.find('\0'), text.size()));
    const std::size_t first = text.find_first_not_of(" +");
    if (first == std::string::npos) return std::nullopt;
    const std::size_t last = text.find_last_not_of(' ');
    double value = 0;
    const char* const end = text.data() + last + 1;
    const auto [stop, error] = std::from_chars(text.data() + first, end, value);
    if (error != std::errc() || stop != end || !std::isfinite(value)) return std::nullopt;
    return value;
}

}  // namespace tex::reader
