// SPDX-License-Identifier: Apache-2.0

#include "rows/roughness_rows.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>

#include <half.h>

#include "blocks/extent.h"
#include "rows/codecs.h"

namespace tex::inline v1 {
namespace {

constexpr RoughnessParts kRoughnessAlone = {RoughnessPart::roughness};

// Makes the rows of a channel.
class ChannelRow {
public:
    ChannelRow(const Plane<float>& roughness, int first, const RoughnessParts& parts, const ChannelPlanes* kept)
        : roughness_(roughness), first_(first), parts_(parts), kept_(kept) {}

    [[nodiscard]] int width() const { return roughness_.extent().width; }

    // Row j of `roughness`, for the channel.
    void make(int j, std::size_t channel, float* to) const {
        const float* const from = roughness_.row(j);
        switch (parts_[channel]) {
            case RoughnessPart::roughness: std::copy_n(from, width(), to); break;
            case RoughnessPart::smoothness:
                std::transform(from, from + width(), to, [](float value) { return 1.0f - value; });
                break;
            case RoughnessPart::zero: std::fill_n(to, width(), 0.0f); break;
            case RoughnessPart::one: std::fill_n(to, width(), 1.0f); break;
            case RoughnessPart::kept:
                if (kept_ == nullptr || (*kept_)[channel].empty())
                    std::fill_n(to, width(), 1.0f);
                else
                    std::copy_n((*kept_)[channel].row(first_ + j), width(), to);
                break;
        }
    }

private:
    const Plane<float>& roughness_;
    int first_;
    const RoughnessParts& parts_;
    const ChannelPlanes* kept_;
};

// Rows [begin, end). A block of one channel is the first half of a block of two: BC4 of BC5, EAC R11 of RG11.
void pack_halves(const ChannelRow& rows, const FormatRow& format, Effort effort, int begin, int end, std::byte* out) {
    constexpr std::size_t kOne = 8, kTwo = 16;
    const int width = rows.width(), channels = format.info.channels;
    const auto count = static_cast<std::size_t>(blocks_across(width));
    Plane<float> planes[2] = {Plane<float>({width, kBlockEdge}), Plane<float>({width, kBlockEdge})};
    std::vector<std::byte> pairs(channels == 1 ? count * kTwo : 0);
    for (int j = begin; j < end; j += kBlockEdge, out += count * format.info.block_bytes) {
        BlockRow row;
        row.width = width;
        row.height = std::min(kBlockEdge, end - j);
        for (int k = 0; k < kBlockEdge; ++k) {
            const int from = std::min(k, row.height - 1);
            for (int c = 0; c < channels && from == k; ++c) {
                float* const to = planes[c].row(k);  // as components of vectors
                rows.make(j + k, static_cast<std::size_t>(c), to);
                for (int i = 0; i < width; ++i) to[i] = 2.0f * to[i] - 1.0f;
            }
            row.x[k] = planes[0].row(from);
            row.y[k] = planes[channels - 1].row(from);
        }
        format.codec->encode_halves(row, effort, channels == 1 ? pairs.data() : out);
        for (std::size_t k = 0; k < pairs.size() / kTwo; ++k)
            std::memcpy(out + k * kOne, pairs.data() + k * kTwo, kOne);
    }
}

bool encodes_values(const FormatRow& row) {
    return row.codec->whole != nullptr && row.codec->whole->encode_values != nullptr;
}

void pack_whole_blocks(const ChannelRow& rows, const FormatRow& format, Effort effort, int begin, int end,
                       std::byte* out) {
    const auto width = static_cast<std::size_t>(rows.width());
    std::vector<float> values(width * static_cast<std::size_t>(end - begin));
    for (int j = begin; j < end; ++j) rows.make(j, 0, values.data() + width * static_cast<std::size_t>(j - begin));
    format.codec->whole->encode_values(format.format, effort, values.data(), {rows.width(), end - begin}, out);
}

bool encodes_colors(const FormatRow& row) {
    return row.codec->whole != nullptr && row.codec->whole->encode_colors != nullptr;
}

void pack_colors(const ChannelRow& rows, const FormatRow& format, Effort effort, int begin, int end, std::byte* out) {
    constexpr std::size_t kColors = 3;
    const auto width = static_cast<std::size_t>(rows.width());
    std::vector<float> row(width), colors(kColors * width * static_cast<std::size_t>(end - begin));
    float* to = colors.data();
    for (int j = begin; j < end; ++j, to += kColors * width) {
        for (std::size_t c = 0; c < kColors; ++c) {
            rows.make(j, c, row.data());
            for (std::size_t i = 0; i < width; ++i) to[kColors * i + c] = row[i];
        }
    }
    format.codec->whole->encode_colors(format.format, effort, colors.data(), {rows.width(), end - begin}, out);
}

template <class Sample, class Convert>
void pack_samples(const ChannelRow& rows, int channels, int begin, int end, Convert convert, std::byte* out) {
    const auto count = static_cast<std::size_t>(rows.width()), step = static_cast<std::size_t>(channels);
    Plane<float> values({rows.width(), 1});
    std::vector<Sample> samples(count * step);
    const std::size_t bytes = samples.size() * sizeof(Sample);
    for (int j = begin; j < end; ++j, out += bytes) {
        for (std::size_t c = 0; c < step; ++c) {
            rows.make(j, c, values.row(0));
            for (std::size_t i = 0; i < count; ++i) samples[i * step + c] = convert(values.row(0)[i]);
        }
        std::memcpy(out, samples.data(), bytes);
    }
}

template <class Code>
Code code_of(float value) {
    constexpr auto kTop = static_cast<float>(std::numeric_limits<Code>::max());
    return static_cast<Code>(std::clamp(value, 0.0f, 1.0f) * kTop + 0.5f);
}

void pack(const ChannelRow& rows, Format format, Effort effort, int begin, int end, std::byte* out) {
    const FormatRow& row = format_row(format);
    const auto& [sample, channels, bits, block, block_bytes] = row.info;
    if (encodes_values(row)) return pack_whole_blocks(rows, row, effort, begin, end, out);
    if (encodes_colors(row)) return pack_colors(rows, row, effort, begin, end, out);
    if (row.codec->encode_halves != nullptr) return pack_halves(rows, row, effort, begin, end, out);
    if (sample == SampleKind::floating && bits == 16)
        return pack_samples<Imath::half>(
            rows, channels, begin, end, [](float v) { return Imath::half(v); }, out);
    if (sample == SampleKind::floating)
        return pack_samples<float>(
            rows, channels, begin, end, [](float v) { return v; }, out);
    if (bits == 16) return pack_samples<std::uint16_t>(rows, channels, begin, end, code_of<std::uint16_t>, out);
    pack_samples<std::uint8_t>(rows, channels, begin, end, code_of<std::uint8_t>, out);
}

}  // namespace

bool holds_roughness(Format format) {
    const FormatRow& row = format_row(format);
    const bool has_halves = row.codec->encode_halves != nullptr && row.info.channels <= 2;
    return row.info.sample != SampleKind::snorm &&
           (!row.info.has_blocks() || has_halves || encodes_values(row) || encodes_colors(row));
}

bool is_single_roughness(Format format) {
    const FormatRow& row = format_row(format);
    return holds_roughness(format) && (row.info.channels == 1 || encodes_values(row) || encodes_colors(row));
}

void pack_roughness_rows(const Plane<float>& level, int height, Format format, Effort effort, int begin, int end,
                         std::byte* out) {
    const ChannelRow rows(level, 0, kRoughnessAlone, nullptr);
    pack(rows, format, effort, begin, std::min(end, height), out + level_bytes(format, {rows.width(), begin}));
}

void pack_roughness_channels(const Plane<float>& roughness, int first, int height, const RoughnessParts& parts,
                             const ChannelPlanes* kept, Format format, Effort effort, std::byte* out) {
    pack(ChannelRow(roughness, first, parts, kept), format, effort, 0, height, out);
}

}  // namespace tex::inline v1
