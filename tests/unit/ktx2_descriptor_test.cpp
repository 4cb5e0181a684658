// SPDX-License-Identifier: Apache-2.0

#include "formats/ktx2/ktx2_descriptor.h"

#include <cstdint>

#include <gtest/gtest.h>

#include "formats/bytes.h"

namespace tex {
namespace {

using Bytes = std::vector<std::byte>;

std::uint32_t descriptor_field(const Bytes& bytes, std::size_t offset) { return load_u32(bytes.data() + offset); }

// A sample of a descriptor: first word (bit offset, bit length - 1, channel with qualifiers), lower, upper.
struct Sample {
    std::uint32_t word, lower, upper;
};

void expect_descriptor(Format format, std::uint32_t model, std::uint32_t block, std::uint32_t bytes,
                       const std::vector<Sample>& samples) {
    const Bytes descriptor = data_format_descriptor(format);
    ASSERT_EQ(descriptor.size(), 28 + 16 * samples.size());
    EXPECT_EQ(descriptor_field(descriptor, 0), descriptor.size());
    EXPECT_EQ(descriptor_field(descriptor, 4), 0u);
    EXPECT_EQ(descriptor_field(descriptor, 8), 2u | static_cast<std::uint32_t>(descriptor.size() - 4) << 16);
    EXPECT_EQ(descriptor_field(descriptor, 12), model | 0x10000u);  // no primaries, linear, straight alpha
    EXPECT_EQ(descriptor_field(descriptor, 16), block);
    EXPECT_EQ(descriptor_field(descriptor, 20), bytes);
    for (std::size_t k = 0; k < samples.size(); ++k) {
        EXPECT_EQ(descriptor_field(descriptor, 28 + 16 * k), samples[k].word);
        EXPECT_EQ(descriptor_field(descriptor, 36 + 16 * k), samples[k].lower);
        EXPECT_EQ(descriptor_field(descriptor, 40 + 16 * k), samples[k].upper);
    }
}

// The values that Khronos' libktx (dfdutils) gives for these VkFormats, except for the primaries.
TEST(Ktx2Descriptor, DescribesFormatsAsKhronosDoes) {
    expect_descriptor(Format::bc3_unorm, 130, 0x303, 16, {{0x0f3f0000, 0, 0xffffffff}, {0x003f0040, 0, 0xffffffff}});
    expect_descriptor(Format::bc5_unorm, 132, 0x303, 16, {{0x003f0000, 0, 0xffffffff}, {0x013f0040, 0, 0xffffffff}});
    expect_descriptor(Format::bc5_snorm, 132, 0x303, 16,
                      {{0x403f0000, 0x80000000, 0x7fffffff}, {0x413f0040, 0x80000000, 0x7fffffff}});
    expect_descriptor(Format::eac_r11_unorm, 161, 0x303, 8, {{0x003f0000, 0, 0xffffffff}});
    expect_descriptor(Format::eac_r11_snorm, 161, 0x303, 8, {{0x403f0000, 0x80000000, 0x7fffffff}});
    expect_descriptor(Format::eac_rg11_unorm, 161, 0x303, 16,
                      {{0x003f0000, 0, 0xffffffff}, {0x013f0040, 0, 0xffffffff}});
    expect_descriptor(Format::eac_rg11_snorm, 161, 0x303, 16,
                      {{0x403f0000, 0x80000000, 0x7fffffff}, {0x413f0040, 0x80000000, 0x7fffffff}});
    expect_descriptor(Format::astc_4x4_unorm, 162, 0x303, 16, {{0x007f0000, 0, 0xffffffff}});
    expect_descriptor(Format::astc_8x5_unorm, 162, 0x407, 16, {{0x007f0000, 0, 0xffffffff}});
    expect_descriptor(Format::rgb8_unorm, 1, 0, 3, {{0x00070000, 0, 255}, {0x01070008, 0, 255}, {0x02070010, 0, 255}});
    expect_descriptor(Format::rg16_unorm, 1, 0, 4, {{0x000f0000, 0, 65535}, {0x010f0010, 0, 65535}});
    expect_descriptor(Format::r8_snorm, 1, 0, 1, {{0x40070000, 0xffffff81, 127}});
    expect_descriptor(Format::rgba16_float, 1, 0, 8,
                      {{0xc00f0000, 0xbf800000, 0x3f800000},
                       {0xc10f0010, 0xbf800000, 0x3f800000},
                       {0xc20f0020, 0xbf800000, 0x3f800000},
                       {0xcf0f0030, 0xbf800000, 0x3f800000}});
}

}  // namespace
}  // namespace tex
