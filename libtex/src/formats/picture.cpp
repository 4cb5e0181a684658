// SPDX-License-Identifier: Apache-2.0

#include "formats/picture.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

#include <half.h>

#include "formats/channels.h"
#include "formats/normal_mark.h"
#include "rows/channel_names.h"

namespace tex::inline v1 {
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

// The plane for each channel, in the order of the channels. Names that say nothing leave the order of the file. Errors:
// as normal_channels().
Result<std::vector<std::size_t>> planes_of(const std::vector<std::string>& names) {
    Result<NormalChannels> named = normal_channels(names);
    if (!named) return named.error();
    if (!named->channels.empty()) return std::move(named->channels);
    std::vector<std::size_t> planes;
    for (std::size_t k = 0; k < names.size(); ++k) planes.push_back(k);
    if (names.size() == 2 && names[0] == "Y" && is_alpha(names[1])) planes.insert(planes.begin(), 2, 0);
    return planes;
}

// The nearest code. A sum that is not negative is rounded by cutting it off, for which every processor has vectors.
std::int32_t code_of(float value, float greatest) {
    return static_cast<std::int32_t>(std::min(std::max(value, 0.0f), 1.0f) * greatest + 0.5f);
}

// Stores values as samples `step` bytes apart. They come from samples of at most this depth, so nothing is lost.
template <class Code, class Convert>
void store_samples(const float* values, int count, std::size_t step, const Convert& convert, std::byte* out) {
    for (int i = 0; i < count; ++i) {
        const Code code = convert(values[i]);
        std::memcpy(out + static_cast<std::size_t>(i) * step, &code, sizeof code);
    }
}

void store_channel(const FormatInfo& info, const float* values, int count, std::byte* out) {
    const auto step = static_cast<std::size_t>(info.block_bytes);
    const auto half = [](float value) { return Imath::half(value).bits(); };
    const auto same = [](float value) { return value; };
    const auto code8 = [](float value) { return static_cast<std::uint8_t>(code_of(value, 255.0f)); };
    const auto code16 = [](float value) { return static_cast<std::uint16_t>(code_of(value, 65535.0f)); };
    if (info.bits == 8) {
        store_samples<std::uint8_t>(values, count, step, code8, out);
    } else if (info.bits == 32) {
        store_samples<float>(values, count, step, same, out);
    } else if (info.sample == SampleKind::floating) {
        store_samples<std::uint16_t>(values, count, step, half, out);
    } else {
        store_samples<std::uint16_t>(values, count, step, code16, out);
    }
}

}  // namespace

Result<PictureTexture> picture_texture_of(const std::vector<std::string>& names, SampleKind sample, int bits) {
    PictureTexture picture;
    Result<std::vector<std::size_t>> planes = planes_of(names);
    if (!planes) return planes.error();
    picture.planes = std::move(*planes);
    if (picture.planes.empty() || picture.planes.size() > 4) {
        return Error{ErrorCode::unsupported,
                     {},
                     std::to_string(names.size()) +
                         " channels, which are not called R, G, B or X, Y, Z; their names are " + list_of_names(names)};
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

void store_texels(const Image& image, int rows, Format format, const std::vector<std::size_t>& planes, std::byte* out) {
    const FormatInfo info = format_info(format);
    const int width = image.extent().width;
    const std::size_t sample_bytes = info.block_bytes / planes.size();
    for (int j = 0; j < rows; ++j) {
        for (std::size_t c = 0; c < planes.size(); ++c)
            store_channel(info, image.planes[planes[c]].row(j), width, out + c * sample_bytes);
        out += static_cast<std::size_t>(width) * info.block_bytes;
    }
}

}  // namespace tex::inline v1
