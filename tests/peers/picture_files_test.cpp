// SPDX-License-Identifier: Apache-2.0
// TGA and BMP files of every kind, as OpenImageIO and ImageMagick read them.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>

#include <OpenImageIO/imageio.h>

#include "peer_texture.h"
#include "reference/bmp_file.h"
#include "reference/tga_file.h"

namespace {

using tex::reference::BmpFile;
using tex::reference::FileBytes;
using tex::reference::TgaFile;

std::uint32_t texel(int i, int j) { return (static_cast<std::uint32_t>(i / 2 + j * 3) * 2654435761u) ^ 0x7c3a5a96; }

std::string write(const std::string& name, const FileBytes& bytes) {
    const std::string path = peers::scratch_path(name);
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    return path;
}

// Codes of 8 bits, the first `channels` of each texel.
struct Codes {
    int channels = 0;
    std::vector<unsigned char> codes;
};

Codes by_openimageio(const std::string& path) {
    OIIO::ImageSpec config;
    config.attribute("oiio:UnassociatedAlpha", 1);
    const auto input = OIIO::ImageInput::open(path, &config);
    if (!input) return {};
    const OIIO::ImageSpec spec = input->spec();
    Codes read{spec.nchannels, {}};
    read.codes.resize(static_cast<std::size_t>(spec.width * spec.height * spec.nchannels));
    if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::UINT8, read.codes.data())) return {};
    return read;
}

Codes by_imagemagick(const std::string& path, int channels) {
    const std::string raw = peers::scratch_path("magick.raw");
    const char* const maps[] = {"", "gray", "", "rgb", "rgba"};
    const std::string command =
        "convert '" + path + "' -auto-orient -depth 8 '" + maps[channels] + ":" + raw + "' 2>/dev/null";
    if (std::system(command.c_str()) != 0) return {};
    std::ifstream file(raw, std::ios::binary);
    return {channels, {std::istreambuf_iterator<char>(file), {}}};
}

void expect_same(const std::string& path, const Codes& theirs, const char* judge) {
    const auto image = tex::read_image(path);
    ASSERT_TRUE(image) << image.error().message();
    ASSERT_EQ(theirs.codes.size(),
              static_cast<std::size_t>(image->extent().texels()) * static_cast<std::size_t>(theirs.channels))
        << judge;
    const auto ours = static_cast<int>(image->planes.size());
    for (int c = 0; c < theirs.channels; ++c) {
        const bool is_absent = c >= ours && ours > 1;  // alpha that a file does not have
        if (is_absent) continue;
        const auto& plane = image->planes[static_cast<std::size_t>(ours == 1 ? 0 : c)];
        for (int j = 0; j < image->extent().height; ++j) {
            for (int i = 0; i < image->extent().width; ++i) {
                const auto k = static_cast<std::size_t>((j * image->extent().width + i) * theirs.channels + c);
                // They widen 5 bits to 8, by repeating bits or by cutting off.
                const float tolerance = image->bits == 8 ? 0.01f : 1.0f;
                ASSERT_NEAR(plane.at(i, j) * 255.0f, static_cast<float>(theirs.codes[k]), tolerance)
                    << judge << ": " << i << "," << j << " channel " << c;
            }
        }
    }
}

void expect_as_both(const std::string& path, int channels) {
    expect_same(path, by_openimageio(path), "OpenImageIO");
    expect_same(path, by_imagemagick(path, channels), "ImageMagick");
}

struct Kind {
    int type, depth, palette_depth, alpha_bits;
};

TEST(PictureFiles, TgaIsReadAsOpenImageIoAndImageMagickReadIt) {
    const Kind kinds[] = {{2, 15, 0, 0}, {2, 16, 0, 0}, {2, 24, 0, 0}, {2, 32, 0, 8},
                          {3, 8, 0, 0},  {1, 8, 16, 0}, {1, 8, 24, 0}};
    for (const Kind& kind : kinds) {
        for (int form = 0; form < 16; ++form) {
            TgaFile file;
            file.width = 19;
            file.height = 11;
            file.type = kind.type + ((form & 1) != 0 ? 8 : 0);
            file.depth = kind.depth;
            file.palette_depth = kind.palette_depth;
            file.alpha_bits = kind.alpha_bits;
            file.from_top = (form & 2) != 0;
            file.from_right = (form & 4) != 0;
            file.attribute_type = (form & 8) == 0 ? -1 : kind.alpha_bits == 0 ? 0 : 3;
            for (int k = 0; k < (kind.palette_depth == 0 ? 0 : 40); ++k)
                file.palette.push_back(texel(2 * k, 1) & 0x7fff);
            file.texel = [&](int i, int j) {
                return kind.palette_depth != 0 ? texel(i, j) % 40
                       : kind.depth < 24       ? texel(i, j) & 0x7fff
                                               : texel(i, j);
            };
            SCOPED_TRACE(testing::Message() << "type " << file.type << " depth " << file.depth << " form " << form);
            expect_as_both(write("a.tga", file.make()), kind.type == 3 ? 1 : kind.alpha_bits == 8 ? 4 : 3);
        }
    }
}

TEST(PictureFiles, BmpIsReadAsOpenImageIoAndImageMagickReadIt) {
    for (const int depth : {1, 4, 8, 16, 24, 32}) {
        for (const std::uint32_t header : {12u, 40u, 108u, 124u}) {
            for (const bool from_top : {false, true}) {
                if (header == 12 && (depth == 16 || depth == 32 || from_top)) continue;
                BmpFile file;
                file.width = 19;
                file.height = 11;
                file.depth = depth;
                file.header = header;
                file.from_top = from_top;
                for (int k = 0; k < (depth <= 8 ? 1 << depth : 0); ++k)
                    file.palette.push_back(texel(2 * k, 1) & 0xffffff);
                if (depth == 16 && header > 40) {
                    file.compression = 3;
                    file.masks = {0xf800, 0x7e0, 0x1f, 0};
                }
                if (depth == 32 && header > 40) {
                    file.compression = 3;
                    file.masks = {0xff0000, 0xff00, 0xff, 0xff000000};
                }
                file.texel = [depth](int i, int j) { return depth <= 8 ? texel(i, j) % (1u << depth) : texel(i, j); };
                SCOPED_TRACE(testing::Message() << depth << " bits, header " << header << " top " << from_top);
                expect_as_both(write("a.bmp", file.make()), depth == 32 && header > 40 ? 4 : 3);
            }
        }
    }
}

TEST(PictureFiles, RleOfBmpIsReadAsOpenImageIoAndImageMagickReadIt) {
    for (const int depth : {4, 8}) {
        for (const int width : {1, 7, 300}) {
            BmpFile file;
            file.width = width;
            file.height = 11;
            file.depth = depth;
            file.compression = depth == 8 ? 1 : 2;
            for (int k = 0; k < 1 << depth; ++k) file.palette.push_back(texel(2 * k, 1) & 0xffffff);
            file.texel = [depth](int i, int j) { return texel(i, j) % (1u << depth); };
            SCOPED_TRACE(testing::Message() << "RLE" << depth << ", width " << width);
            expect_as_both(write("a.bmp", file.make()), 3);
        }
    }
}

// What libtex writes.
TEST(PictureFiles, OpenImageIoAndImageMagickReadWhatIsWritten) {
    for (const tex::Format format : {tex::Format::r8_unorm, tex::Format::rgb8_unorm, tex::Format::rgba8_unorm}) {
        tex::Texture texture;
        texture.format = format;
        texture.levels.push_back({{19, 11}, std::vector<std::byte>(tex::level_bytes(format, {19, 11}))});
        for (std::size_t k = 0; k < texture.levels[0].bytes.size(); ++k)
            texture.levels[0].bytes[k] = static_cast<std::byte>(texel(static_cast<int>(k), 0));
        for (const char* const name : {"o.tga", "o.bmp"}) {
            const std::string path = peers::scratch_path(name);
            if (!tex::can_hold(*tex::container_of(path), format)) continue;
            ASSERT_TRUE(tex::write_texture(path, texture));
            SCOPED_TRACE(testing::Message() << name << " " << tex::name_of(tex::kFormatNames, format));
            expect_as_both(path, tex::format_info(format).channels);
            const auto image = tex::read_texture(path);
            ASSERT_TRUE(image);
            EXPECT_EQ(image->levels[0].bytes, texture.levels[0].bytes);
        }
    }
}

}  // namespace
