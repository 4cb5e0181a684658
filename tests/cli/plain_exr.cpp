// SPDX-License-Identifier: Apache-2.0

#include "cli/plain_exr.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <memory>

#include <libdeflate.h>

namespace tex::cli {
namespace {

template <class T>
T little_endian(const std::string& file, std::size_t at) {  // 0 beyond the end; this machine is little-endian
    T value{};
    if (at <= file.size() && file.size() - at >= sizeof value) std::memcpy(&value, file.data() + at, sizeof value);
    return value;
}

// The end of a header, a list of attributes: name, type, size, value. It ends with an empty name.
std::size_t end_of_header(const std::string& file) {
    std::size_t at = 8;
    while (at < file.size() && file[at] != '\0') {
        at = file.find('\0', at);
        if (at != std::string::npos) at = file.find('\0', at + 1);
        if (at == std::string::npos) return at;
        at += 1 + 4 + little_endian<std::uint32_t>(file, at + 1);
    }
    return at + 1;
}

// The bytes of a chunk before OpenEXR's ZIP: it stores those at even places and then those at odd ones, as differences
// with 128 added, deflated. A chunk that this would not make smaller is stored as it is.
std::string unzipped(std::string_view chunk) {
    constexpr std::size_t kMost = std::size_t{8} << 20;
    const std::unique_ptr<libdeflate_decompressor, void (*)(libdeflate_decompressor*)> inflater(
        libdeflate_alloc_decompressor(), libdeflate_free_decompressor);
    std::string out(kMost, '\0');
    std::size_t size = 0;
    const bool is_zip = libdeflate_zlib_decompress(inflater.get(), chunk.data(), chunk.size(), out.data(), out.size(),
                                                   &size) == LIBDEFLATE_SUCCESS;
    if (!is_zip) return std::string(chunk);
    for (std::size_t k = 1; k < size; ++k) out[k] = static_cast<char>(out[k - 1] + out[k] - 128);
    std::string bytes(size, '\0');
    for (std::size_t k = 0; k < size; ++k) bytes[k] = out[k / 2 + (k % 2 == 0 ? 0 : (size + 1) / 2)];
    return bytes;
}

}  // namespace

std::string plain_exr(const std::string& file) {
    if (little_endian<std::uint32_t>(file, 0) != 20000630) return file;
    const bool is_tiled = (little_endian<std::uint32_t>(file, 4) & 0x200U) != 0;
    const std::size_t place = is_tiled ? 16 : 4;  // what stands before the size of a chunk: coordinates
    const std::size_t table = end_of_header(file);
    std::uint64_t first = file.size();  // the table ends where the first chunk begins
    for (std::size_t at = table; at < first; at += 8) first = std::min(first, little_endian<std::uint64_t>(file, at));
    std::string plain = file.substr(0, table);
    for (std::size_t at = first; at < file.size();) {
        const std::size_t data = at + place + 4;
        const auto size = little_endian<std::uint32_t>(file, at + place);
        if (data > file.size() || size > file.size() - data) return file;
        plain.append(file, at, place);
        plain += unzipped(std::string_view(file).substr(data, size));
        at = data + size;
    }
    return plain;
}

}  // namespace tex::cli
