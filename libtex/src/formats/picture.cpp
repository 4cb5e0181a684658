// SPDX-License-Identifier: Apache-2.0

#include "formats/picture.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

#include <half.h>

#include "formats/dds/dds_format.h"

namespace tex {
namespace {

enum class Sample { unorm8, unorm16, half, floating };

Sample sample_of(SampleKind kind, int bits) {
    if (kind == SampleKind::floating) return bits == 16 ? Sample::half : Sample::floating;
    if (kind == SampleKind::snorm || bits > 16) return Sample::floating;
    const bool exact = bits == 1 || bits == 2 || bits == 4 || bits == 8;
    return exact ? Sample::unorm8 : Sample::unorm16;
}

Format format_of(Sample sample, std::size_t channels) {
    constexpr Format kFormats[4][4] = {
        {Format::r8_unorm, Format::rg8_unorm, Format::rgb8_unorm, Format::rgba8_unorm},
        {Format::r16_unorm, Format::rg16_unorm, Format::rgb16_unorm, Format::rgba16_unorm},
        {Format::r16_float, Format::rg16_float, Format::rgb16_float, Format::rgba16_float},
        {Format::r32_float, Format::rg32_float, Format::rgb32_float, Format::rgba32_float},
    };
    return kFormats[static_cast<int>(sample)][channels - 1];
}

// The planes of the channels, in their order.
std::vector<std::size_t> planes_of(const std::vector<std::string>& names) {
    std::vector<std::size_t> planes;
    const auto find = [&](const char* name) { return std::find(names.begin(), names.end(), name); };
    const auto add = [&](const char* name) {
        if (const auto found = find(name); found != names.end())
            planes.push_back(static_cast<std::size_t>(found - names.begin()));
    };
    if (find("R") != names.end()) {
        for (const char* name : {"R", "G", "B", "A"}) add(name);
    } else if (names.size() == 2 && find("Y") != names.end() && find("A") != names.end()) {
        for (const char* name : {"Y", "Y", "Y", "A"}) add(name);
    } else {
        for (std::size_t k = 0; k < names.size(); ++k) planes.push_back(k);
    }
    return planes;
}

std::uint32_t code_of(float value, float greatest) {
    return static_cast<std::uint32_t>(std::floor(std::min(std::max(value, 0.0f), 1.0f) * greatest + 0.5f));
}

// Stores `value` as a sample. Values come from samples of at most this depth: nothing is lost.
void store(Sample sample, float value, std::byte* out) {
    switch (sample) {
        case Sample::unorm8: *out = static_cast<std::byte>(code_of(value, 255.0f)); break;
        case Sample::unorm16: {
            const auto bits = static_cast<std::uint16_t>(code_of(value, 65535.0f));
            std::memcpy(out, &bits, sizeof bits);
            break;
        }
        case Sample::half: {
            const std::uint16_t bits = Imath::half(value).bits();
            std::memcpy(out, &bits, sizeof bits);
            break;
        }
        case Sample::floating: std::memcpy(out, &value, sizeof value); break;
    }
}

}  // namespace

Result<PictureTexture> picture_texture_of(const std::vector<std::string>& names, SampleKind sample, int bits) {
    PictureTexture picture;
    picture.planes = planes_of(names);
    if (picture.planes.empty() || picture.planes.size() > 4) {
        return Error{ErrorCode::unsupported,
                     {},
                     "a picture of " + std::to_string(picture.planes.size()) + " channels, none of them called R"};
    }
    const Sample stored = sample_of(sample, bits);
    picture.head.format = format_of(stored, picture.planes.size());
    picture.head.swizzle = likely_swizzle(picture.head.format);
    picture.rounds = stored == Sample::unorm16 && bits != 16;
    return picture;
}

void round_to_texels(const float* values, int count, float* out) {
    for (int i = 0; i < count; ++i) out[i] = static_cast<float>(code_of(values[i], 65535.0f)) / 65535.0f;
}

Result<Texture> texture_of(const Image& image) {
    Result<PictureTexture> picture = picture_texture_of(image.names, image.sample, image.bits);
    if (!picture) return std::move(picture).error();
    Texture texture = std::move(picture->head);
    texture.normal_encoding = image.normal_encoding;
    const Sample sample = sample_of(image.sample, image.bits);
    const Extent extent = image.extent();
    Level level{extent, std::vector<std::byte>(level_bytes(texture.format, extent))};
    const std::size_t sample_bytes = format_info(texture.format).block_bytes / picture->planes.size();
    std::byte* out = level.bytes.data();
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            for (const std::size_t plane : picture->planes) {
                store(sample, image.planes[plane].at(i, j), out);
                out += sample_bytes;
            }
        }
    }
    texture.levels.push_back(std::move(level));
    return texture;
}

}  // namespace tex
