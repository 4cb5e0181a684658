// SPDX-License-Identifier: Apache-2.0

#include "rows/roughness_channels.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <limits>

#include <half.h>

#include "blocks/extent.h"
#include "kernels/encode.h"
#include "kernels/encode_astc.h"
#include "rows/roughness_rows.h"

namespace tex::inline v1 {
namespace {

constexpr Format kSingle[] = {Format::bc4_unorm, Format::eac_r11_unorm, Format::r8_unorm,
                              Format::r16_unorm, Format::r16_float,     Format::r32_float};
constexpr Format kSeveral[] = {Format::bc5_unorm,   Format::eac_rg11_unorm, Format::rg8_unorm,    Format::rgb8_unorm,
                               Format::rgba8_unorm, Format::rg16_unorm,     Format::rgb16_unorm,  Format::rgba16_unorm,
                               Format::rg16_float,  Format::rgb16_float,    Format::rgba16_float, Format::rg32_float,
                               Format::rgb32_float, Format::rgba32_float};

template <std::size_t N>
bool is_one_of(const Format (&formats)[N], Format format) {
    return std::find(std::begin(formats), std::end(formats), format) != std::end(formats);
}

// Makes the rows of a channel.
class ChannelRow {
public:
    ChannelRow(const Plane<float>& roughness, int first, const RoughnessParts& parts, const ChannelPlanes* kept)
        : roughness_(roughness), first_(first), parts_(parts), kept_(kept) {}

    // Row j of `roughness`, for the channel.
    void make(int j, std::size_t channel, float* to) const {
        const int width = roughness_.extent().width;
        const float* const from = roughness_.row(j);
        switch (parts_[channel]) {
            case RoughnessPart::roughness: std::copy_n(from, width, to); break;
            case RoughnessPart::smoothness:
                std::transform(from, from + width, to, [](float value) { return 1.0f - value; });
                break;
            case RoughnessPart::zero: std::fill_n(to, width, 0.0f); break;
            case RoughnessPart::one: std::fill_n(to, width, 1.0f); break;
            case RoughnessPart::kept:
                if (kept_ == nullptr || (*kept_)[channel].empty())
                    std::fill_n(to, width, 1.0f);
                else
                    std::copy_n((*kept_)[channel].row(first_ + j), width, to);
                break;
        }
    }

private:
    const Plane<float>& roughness_;
    int first_;
    const RoughnessParts& parts_;
    const ChannelPlanes* kept_;
};

template <class Encode>
void pack_pairs(const ChannelRow& rows, int width, int height, Effort effort, Encode encode, std::byte* out) {
    constexpr std::size_t kBytes = 16;
    Plane<float> x({width, kBlockEdge}), y({width, kBlockEdge});
    const auto take = [&](int j, std::size_t channel, float* to) {  // as components of vectors
        rows.make(j, channel, to);
        for (int i = 0; i < width; ++i) to[i] = 2.0f * to[i] - 1.0f;
    };
    for (int j = 0; j < height; j += kBlockEdge) {
        BlockRow row;
        row.width = width;
        row.height = std::min(kBlockEdge, height - j);
        for (int k = 0; k < kBlockEdge; ++k) {
            if (k < row.height) {
                take(j + k, 0, x.row(k));
                take(j + k, 1, y.row(k));
            }
            row.x[k] = k < row.height ? x.row(k) : row.x[k - 1];
            row.y[k] = k < row.height ? y.row(k) : row.y[k - 1];
        }
        encode(
            row, effort,
            out + static_cast<std::size_t>(j / kBlockEdge) * static_cast<std::size_t>(blocks_across(width)) * kBytes);
    }
}

template <class Sample, class Convert>
void pack_samples(const ChannelRow& rows, int width, int height, int channels, Convert convert, std::byte* out) {
    const auto count = static_cast<std::size_t>(width), step = static_cast<std::size_t>(channels);
    Plane<float> values({width, 1});
    std::vector<Sample> samples(count * step);
    for (int j = 0; j < height; ++j) {
        for (std::size_t c = 0; c < step; ++c) {
            rows.make(j, c, values.row(0));
            for (std::size_t i = 0; i < count; ++i) samples[i * step + c] = convert(values.row(0)[i]);
        }
        const std::size_t bytes = samples.size() * sizeof(Sample);
        std::memcpy(out + static_cast<std::size_t>(j) * bytes, samples.data(), bytes);
    }
}

template <class Code>
Code code_of(float value) {
    constexpr auto kTop = static_cast<float>(std::numeric_limits<Code>::max());
    return static_cast<Code>(std::clamp(value, 0.0f, 1.0f) * kTop + 0.5f);
}

}  // namespace

bool holds_roughness(Format format) {
    return is_one_of(kSingle, format) || is_one_of(kSeveral, format) || encodes_astc(format);
}

void pack_roughness_channels(const Plane<float>& roughness, int first, int height, const RoughnessParts& parts,
                             const ChannelPlanes* kept, Format format, Effort effort, std::byte* out) {
    const int width = roughness.extent().width;
    const ChannelRow rows(roughness, first, parts, kept);
    if (!is_one_of(kSeveral, format)) {
        if (parts[0] == RoughnessPart::roughness)
            return pack_roughness_rows(roughness, height, format, effort, 0, height, out);
        Plane<float> single(roughness.extent());
        for (int j = 0; j < height; ++j) rows.make(j, 0, single.row(j));
        return pack_roughness_rows(single, height, format, effort, 0, height, out);
    }
    if (format == Format::bc5_unorm) return pack_pairs(rows, width, height, effort, encode_bc5_unorm, out);
    if (format == Format::eac_rg11_unorm) return pack_pairs(rows, width, height, effort, encode_eac_unorm, out);
    const FormatInfo info = format_info(format);
    const int channels = info.channels;
    if (info.sample == SampleKind::floating && info.bits == 16)
        return pack_samples<Imath::half>(
            rows, width, height, channels, [](float v) { return Imath::half(v); }, out);
    if (info.sample == SampleKind::floating)
        return pack_samples<float>(
            rows, width, height, channels, [](float v) { return v; }, out);
    if (info.bits == 16) return pack_samples<std::uint16_t>(rows, width, height, channels, code_of<std::uint16_t>, out);
    pack_samples<std::uint8_t>(rows, width, height, channels, code_of<std::uint8_t>, out);
}

}  // namespace tex::inline v1
