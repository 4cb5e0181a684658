// SPDX-License-Identifier: Apache-2.0

#include "formats/picture.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

#include <half.h>

#include "formats/channels.h"
#include "formats/normal_mark.h"

namespace tex {
namespace {

// The smallest sample type of a Format that holds the samples of a picture unchanged.
struct Sample {
    SampleKind kind;
    int bits;
};

Sample sample_of(SampleKind kind, int bits) {
    if (kind == SampleKind::floating) return {kind, bits == 16 ? 16 : 32};
    if (kind == SampleKind::snorm || bits > 16) return {SampleKind::floating, 32};
    const bool exact = bits == 1 || bits == 2 || bits == 4 || bits == 8;
    return {kind, exact ? 8 : 16};
}

// The plane for each channel, in the order of the channels.
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

// Stores `value` as a sample. The values come from samples of at most this depth, so nothing is lost.
template <class Code>
void store_as(Code code, std::byte* out) {
    std::memcpy(out, &code, sizeof code);
}
void store(const FormatInfo& info, float value, std::byte* out) {
    const bool is_float = info.sample == SampleKind::floating;
    if (info.bits == 8) {
        *out = static_cast<std::byte>(code_of(value, 255.0f));
    } else if (info.bits == 16) {
        store_as(is_float ? Imath::half(value).bits() : static_cast<std::uint16_t>(code_of(value, 65535.0f)), out);
    } else {
        store_as(value, out);
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
    picture.head.format = *format_of(stored.kind, stored.bits, static_cast<int>(picture.planes.size()));
    picture.head.swizzle = likely_swizzle(picture.head.format);
    picture.rounds = stored.kind == SampleKind::unorm && stored.bits == 16 && bits != 16;
    return picture;
}

void round_to_texels(const float* values, int count, float* out) {
    for (int i = 0; i < count; ++i) out[i] = static_cast<float>(code_of(values[i], 65535.0f)) / 65535.0f;
}

Level level_of(const Image& image, Format format, const std::vector<std::size_t>& planes) {
    const FormatInfo info = format_info(format);
    const Extent extent = image.extent();
    Level level{extent, std::vector<std::byte>(level_bytes(format, extent))};
    const std::size_t sample_bytes = info.block_bytes / planes.size();
    std::byte* out = level.bytes.data();
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            for (const std::size_t plane : planes) {
                store(info, image.planes[plane].at(i, j), out);
                out += sample_bytes;
            }
        }
    }
    return level;
}

Result<Texture> texture_of(const Image& image) {
    Result<PictureTexture> picture = picture_texture_of(image.names, image.sample, image.bits);
    if (!picture) return std::move(picture).error();
    Texture texture = std::move(picture->head);
    texture.normal_encoding = image.normal_encoding;
    apply_found_mark(image.normal_mark, texture);
    texture.levels.push_back(level_of(image, texture.format, picture->planes));
    return texture;
}

}  // namespace tex
