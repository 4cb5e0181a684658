// SPDX-License-Identifier: Apache-2.0

#include "containers/picture.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

#include <half.h>

#include "containers/dds_format.h"

namespace tex {
namespace {

enum class Sample { unorm8, unorm16, half, floating };

Sample sample_of(const Image& image) {
    if (image.sample == SampleKind::floating) return image.bits == 16 ? Sample::half : Sample::floating;
    if (image.sample == SampleKind::snorm || image.bits > 16) return Sample::floating;
    const bool exact = image.bits == 1 || image.bits == 2 || image.bits == 4 || image.bits == 8;
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
std::vector<const Plane<float>*> channels_of(const Image& image) {
    std::vector<const Plane<float>*> channels;
    const auto add = [&](const char* name) {
        const int k = image.find(name);
        if (k >= 0) channels.push_back(&image.planes[static_cast<std::size_t>(k)]);
    };
    if (image.find("R") >= 0) {
        for (const char* name : {"R", "G", "B", "A"}) add(name);
    } else if (image.planes.size() == 2 && image.find("Y") >= 0 && image.find("A") >= 0) {
        for (const char* name : {"Y", "Y", "Y", "A"}) add(name);
    } else {
        for (const Plane<float>& plane : image.planes) channels.push_back(&plane);
    }
    return channels;
}

// Stores `value` as a sample. Values come from samples of at most this depth: nothing is lost.
void store(Sample sample, float value, std::byte* out) {
    const auto code = [&](float greatest) {
        return static_cast<std::uint32_t>(std::floor(std::min(std::max(value, 0.0f), 1.0f) * greatest + 0.5f));
    };
    switch (sample) {
        case Sample::unorm8: *out = static_cast<std::byte>(code(255.0f)); break;
        case Sample::unorm16: {
            const auto bits = static_cast<std::uint16_t>(code(65535.0f));
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

Result<Texture> texture_of(const Image& image) {
    const std::vector<const Plane<float>*> channels = channels_of(image);
    if (channels.empty() || channels.size() > 4) {
        return Error{ErrorCode::unsupported, {},
                     "a picture of " + std::to_string(channels.size()) + " channels, none of them called R"};
    }
    const Sample sample = sample_of(image);
    Texture texture;
    texture.format = format_of(sample, channels.size());
    texture.swizzle = likely_swizzle(texture.format);
    texture.normal_encoding = image.normal_encoding;
    const Extent extent = image.extent();
    Level level{extent, std::vector<std::byte>(level_bytes(texture.format, extent))};
    const std::size_t sample_bytes = format_info(texture.format).block_bytes / channels.size();
    std::byte* out = level.bytes.data();
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            for (const Plane<float>* channel : channels) {
                store(sample, channel->at(i, j), out);
                out += sample_bytes;
            }
        }
    }
    texture.levels.push_back(std::move(level));
    return texture;
}

}  // namespace tex
