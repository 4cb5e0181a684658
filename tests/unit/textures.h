// SPDX-License-Identifier: Apache-2.0
// textures.h: files and textures for tests.

#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <tex/format.h>
#include <tex/types.h>

namespace tex {

inline std::filesystem::path shared_data() { return TEX_SOURCE_DIR "/../shared/data"; }

inline std::vector<std::byte> bytes_of(const std::filesystem::path& path) {
    std::ifstream stream(path, std::ios::binary);
    const std::string text((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
    std::vector<std::byte> bytes(text.size());
    for (std::size_t k = 0; k < text.size(); ++k) bytes[k] = static_cast<std::byte>(text[k]);
    return bytes;
}

// The files in a folder of the shared data with this extension (".dds"), sorted by name.
inline std::vector<std::filesystem::path> files_in(const char* folder, const char* extension) {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(shared_data() / folder)) {
        if (entry.path().extension() == extension) files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    return files;
}

// A texture whose bytes run through all values; floats are finite.
inline Texture patterned_texture(Format format, Extent extent, int levels) {
    Texture texture;
    texture.format = format;
    std::uint32_t state = 1;
    for (int k = 0; k < levels; ++k) {
        Level level{level_extent(extent, k), {}};
        level.bytes.resize(level_bytes(format, level.extent));
        for (std::byte& byte : level.bytes) {
            state = state * 1664525u + 1013904223u;
            byte = static_cast<std::byte>(state >> 24);
        }
        if (format_info(format).sample == SampleKind::floating) {  // keep exponents away from infinity
            const auto sample = static_cast<std::size_t>(format_info(format).bits) / 8;
            for (std::size_t b = sample - 1; b < level.bytes.size(); b += sample) level.bytes[b] &= std::byte{0xbb};
        }
        texture.levels.push_back(std::move(level));
    }
    return texture;
}

// A texture that pack() could have made: with the format and swizzle of the encoding, and y up.
inline Texture encoded_texture(Encoding encoding, Extent extent, int levels) {
    Texture texture = patterned_texture(encoding_info(encoding).format, extent, levels);
    texture.swizzle = encoding_info(encoding).swizzle;
    texture.swizzle_known = true;
    texture.y_known = true;
    return texture;
}

// Skips a test if the shared data do not exist.
#define TEX_NEEDS_SHARED_DATA() \
    if (!std::filesystem::exists(tex::shared_data())) GTEST_SKIP() << "../shared/data is not there"

// Changes the bytes [from, to) of a file one at a time to all values: decode_bytes() refuses the file, or its levels
// have the sizes that they must have.
template <class Decode>
void expect_safe_with_any_byte(const std::vector<std::byte>& file, std::size_t from, std::size_t to,
                               const Decode& decode_bytes) {
    for (std::size_t at = from; at < to; ++at) {
        for (unsigned value = 0; value < 256; ++value) {
            std::vector<std::byte> changed = file;
            changed[at] = static_cast<std::byte>(value);
            const Result<Texture> texture = decode_bytes(changed);
            if (!texture) continue;
            for (const Level& level : texture->levels)
                ASSERT_EQ(level.bytes.size(), level_bytes(texture->format, level.extent));
        }
    }
}

}  // namespace tex
