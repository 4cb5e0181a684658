// SPDX-License-Identifier: Apache-2.0
// EXR files that OpenImageIO writes with each of OpenEXR's compressions, lossy ones too: libtex reads the values that
// OpenImageIO reads, to the last bit.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include <OpenImageIO/imageio.h>

#include "peer_texture.h"

namespace {

using OIIO::TypeDesc;

constexpr const char* kCompressions[] = {"none", "rle", "zips", "zip", "piz", "pxr24", "b44", "b44a", "dwaa", "dwab"};

struct Kind {
    tex::Extent extent;
    int channels;
    TypeDesc::BASETYPE type;
    int tile;  // 0: scan lines
};

constexpr Kind kKinds[] = {
    {{67, 45}, 3, TypeDesc::HALF, 0},    {{67, 45}, 3, TypeDesc::FLOAT, 0},  {{300, 270}, 4, TypeDesc::HALF, 0},
    {{67, 45}, 1, TypeDesc::HALF, 0},    {{130, 70}, 3, TypeDesc::HALF, 64}, {{130, 70}, 4, TypeDesc::FLOAT, 64},
    {{1, 1}, 3, TypeDesc::HALF, 0},      {{4, 300}, 3, TypeDesc::HALF, 0},   {{513, 3}, 3, TypeDesc::FLOAT, 0},
    {{256, 256}, 3, TypeDesc::HALF, 32}, {{97, 33}, 4, TypeDesc::FLOAT, 0},  {{64, 64}, 1, TypeDesc::FLOAT, 16},
};

// Smooth waves, noise, and a flat part, which B44A stores in fewer bytes.
std::vector<float> values_of(const Kind& kind) {
    std::vector<float> values;
    std::uint32_t state = 1;
    for (int j = 0; j < kind.extent.height; ++j) {
        for (int i = 0; i < kind.extent.width; ++i) {
            for (int c = 0; c < kind.channels; ++c) {
                state = state * 1664525u + 1013904223u;
                const float noise = static_cast<float>(state >> 8) / 16777216.0f - 0.5f;
                const float wave = std::sin(0.1f * static_cast<float>(i) + 0.07f * static_cast<float>(j * (c + 1)));
                values.push_back(i < kind.extent.width / 3 ? 0.25f : i % 7 == 0 ? 4.0f * noise : wave + 0.01f * noise);
            }
        }
    }
    return values;
}

bool write(const std::string& path, const Kind& kind, const char* compression) {
    OIIO::ImageSpec spec(kind.extent.width, kind.extent.height, kind.channels, TypeDesc(kind.type));
    spec.attribute("compression", compression);
    if (kind.tile > 0) spec.tile_width = spec.tile_height = kind.tile;
    const auto output = OIIO::ImageOutput::create(path);
    return output && output->open(path, spec) && output->write_image(TypeDesc::FLOAT, values_of(kind).data()) &&
           output->close();
}

// Values that OpenImageIO reads from the file: texel by texel, its channels together.
std::vector<float> read(const std::string& path, std::string& compression) {
    const auto input = OIIO::ImageInput::open(path);
    if (!input) return {};
    const OIIO::ImageSpec spec = input->spec();
    compression = spec.get_string_attribute("compression");
    std::vector<float> values(static_cast<std::size_t>(spec.image_pixels()) * static_cast<std::size_t>(spec.nchannels));
    if (!input->read_image(0, 0, 0, spec.nchannels, TypeDesc::FLOAT, values.data())) return {};
    return values;
}

std::uint32_t bits_of(float value) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    return bits;
}

TEST(ExrCompressions, AreReadToTheSameBitsAsByOpenImageIo) {
    int number = 0;
    for (const char* compression : kCompressions) {
        for (const Kind& kind : kKinds) {
            const std::string path = peers::scratch_path("compressed" + std::to_string(number++) + ".exr");
            ASSERT_TRUE(write(path, kind, compression)) << compression << ": " << OIIO::geterror();
            std::string stored;
            const std::vector<float> theirs = read(path, stored);
            ASSERT_FALSE(theirs.empty()) << compression << ": " << OIIO::geterror();
            // OpenImageIO uses ZIP instead of DWA for scan lines of one channel.
            const bool is_zip = stored == "zip" && compression[0] == 'd' && kind.channels == 1 && kind.tile == 0;
            EXPECT_TRUE(stored == compression || is_zip) << compression << ": " << stored;
            const auto ours = tex::read_image(path);
            ASSERT_TRUE(ours) << compression << ": " << ours.error().message();
            ASSERT_EQ(ours->extent(), kind.extent);
            ASSERT_EQ(ours->planes.size(), static_cast<std::size_t>(kind.channels));
            std::size_t at = 0, different = 0;
            for (int j = 0; j < kind.extent.height; ++j) {
                for (int i = 0; i < kind.extent.width; ++i) {
                    for (const auto& plane : ours->planes) {
                        if (bits_of(plane.at(i, j)) != bits_of(theirs[at++])) ++different;
                    }
                }
            }
            EXPECT_EQ(different, 0u) << compression << " " << kind.extent.width << "x" << kind.extent.height << ", "
                                     << kind.channels << " channels";
        }
    }
}

}  // namespace
