// SPDX-License-Identifier: Apache-2.0

#include "formats/ktx2/ktx2_descriptor.h"

#include <bit>
#include <cstdint>

#include "formats/bytes.h"
#include "rows/codecs.h"

namespace tex::inline v1 {
namespace {

// From khr_df.h of the Khronos Data Format Specification.
constexpr std::uint32_t kTransferLinear = 1;
constexpr std::uint32_t kPrimariesUnspecified = 0;
constexpr std::uint32_t kChannelColor = 0;
constexpr std::uint32_t kChannelBc1aAlphaPresent = 1;
constexpr std::uint32_t kChannelAlpha = 15;
constexpr std::uint32_t kQualifierSigned = 0x40;
constexpr std::uint32_t kQualifierFloat = 0x80;

struct Sample {
    std::uint32_t channel = 0;  // including its qualifiers
    std::uint32_t bit_offset = 0;
    std::uint32_t bit_length = 0;
    std::uint32_t lower = 0;  // the code (for floats, the bits) of 0, or of -1 if the sample is signed
    std::uint32_t upper = 0;  // the code of 1
};

Sample block_sample(const FormatInfo& info, std::uint32_t channel, std::uint32_t bit_offset) {
    if (info.sample == SampleKind::snorm) {
        return {channel | kQualifierSigned, bit_offset, 64, 0x80000000u, 0x7fffffffu};
    }
    return {channel, bit_offset, 64, 0, 0xffffffffu};
}

// KHR_DF_CHANNEL_UASTC_...
std::uint32_t uastc_channel(const Swizzle& layout) {
    constexpr std::uint32_t kRgb = 0, kRrrg = 5, kRg = 6;
    return layout == kSwizzleXxxy ? kRrrg : layout == kSwizzleXy ? kRg : kRgb;
}

std::vector<Sample> block_samples(const FormatInfo& info, std::uint32_t model, const Swizzle& layout) {
    switch (model) {
        case kKhrBc1: return {block_sample(info, kChannelBc1aAlphaPresent, 0)};
        case kKhrBc2:
        case kKhrBc3: return {block_sample(info, kChannelAlpha, 0), block_sample(info, kChannelColor, 64)};
        case kKhrBc5: return {block_sample(info, 0, 0), block_sample(info, 1, 64)};  // red, green
        case kKhrEtc2:
            if (info.channels == 2) return {block_sample(info, 0, 0), block_sample(info, 1, 64)};
            return {block_sample(info, 0, 0)};
        case kKhrUastc: return {{uastc_channel(layout), 0, 128, 0, 0xffffffffu}};
        case kKhrBc7:
        case kKhrAstc: return {{0, 0, 128, 0, 0xffffffffu}};  // the whole block
        default: return {block_sample(info, 0, 0)};
    }
}

std::vector<Sample> texel_samples(const FormatInfo& info) {
    const auto bits = static_cast<std::uint32_t>(info.bits);
    std::vector<Sample> samples;
    for (int c = 0; c < info.channels; ++c) {
        Sample sample;
        sample.channel = c == 3 ? kChannelAlpha : static_cast<std::uint32_t>(c);
        sample.bit_offset = static_cast<std::uint32_t>(c) * bits;
        sample.bit_length = bits;
        sample.upper = (1u << (bits % 32)) - 1;
        if (info.sample == SampleKind::snorm) {
            sample.channel |= kQualifierSigned;
            sample.upper >>= 1;
            sample.lower = 0u - sample.upper;
        }
        if (info.sample == SampleKind::floating) {
            sample.channel |= kQualifierSigned | kQualifierFloat;
            sample.lower = std::bit_cast<std::uint32_t>(-1.0f);
            sample.upper = std::bit_cast<std::uint32_t>(1.0f);
        }
        samples.push_back(sample);
    }
    return samples;
}

}  // namespace

std::vector<std::byte> data_format_descriptor(Format format, const Swizzle& layout) {
    const FormatInfo info = format_info(format);
    const std::uint32_t model = format_row(format).codec->khr_model;
    const std::vector<Sample> samples = info.has_blocks() ? block_samples(info, model, layout) : texel_samples(info);
    const auto block_bytes = static_cast<std::uint32_t>(24 + 16 * samples.size());

    ByteWriter writer;
    writer.u32(4 + block_bytes);
    writer.u32(0);                                                           // vendor Khronos, type basic format
    writer.u32(2 | block_bytes << 16);                                       // version 1.3
    writer.u32(model | kPrimariesUnspecified << 8 | kTransferLinear << 16);  // flags 0: straight alpha
    writer.u32(static_cast<std::uint32_t>((info.block.width - 1) | (info.block.height - 1) << 8));
    writer.u32(static_cast<std::uint32_t>(info.block_bytes));
    writer.u32(0);  // planes 4 to 7
    for (const Sample& sample : samples) {
        writer.u32(sample.bit_offset | (sample.bit_length - 1) << 16 | sample.channel << 24);
        writer.u32(0);  // position
        writer.u32(sample.lower);
        writer.u32(sample.upper);
    }
    return writer.take();
}

}  // namespace tex::inline v1
