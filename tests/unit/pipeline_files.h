// SPDX-License-Identifier: Apache-2.0
// pipeline_files.h: pictures of heights, and the fixture of tests that compare bake_stream() with the verbs.

#pragma once

#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <png.h>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfTiledOutputFile.h>
#include <half.h>

#include <tex/file.h>
#include <tex/pipeline.h>

#include "stream/bake_stream.h"
#include "unit/streams.h"

namespace tex {

struct ExrKind {
    Imf::Compression compression = Imf::ZIP_COMPRESSION;
    Imf::PixelType type = Imf::HALF;
    Imf::LineOrder order = Imf::INCREASING_Y;
    int tile = 0;  // 0: scanlines
};

// Bumps, and another channel besides them. The data window begins anywhere.
inline void make_exr(const std::string& path, Extent extent, const ExrKind& kind) {
    const Imath::Box2i window(Imath::V2i(-3, 5), Imath::V2i(extent.width - 4, extent.height + 4));
    Imf::Header header(window, window);
    header.compression() = kind.compression;
    header.lineOrder() = kind.order;
    header.channels().insert("Y", Imf::Channel(kind.type));
    header.channels().insert("A", Imf::Channel(Imf::HALF));
    const auto count = static_cast<std::size_t>(extent.texels());
    std::vector<Imath::half> halves(count);
    std::vector<float> floats(count);
    std::vector<std::uint32_t> integers(count);
    for (std::size_t k = 0; k < count; ++k) {
        const auto i = static_cast<double>(k % static_cast<std::size_t>(extent.width));
        const auto j = static_cast<double>(k / static_cast<std::size_t>(extent.width));
        const double height = 0.5 + 0.4 * std::sin(0.3 * i) * std::cos(0.2 * j);
        halves[k] = Imath::half(static_cast<float>(height));
        floats[k] = static_cast<float>(height);
        integers[k] = static_cast<std::uint32_t>(height * 4e9);
    }
    const auto width = static_cast<std::size_t>(extent.width);
    const auto slice = [&](Imf::PixelType type, const void* data, std::size_t size) {
        return Imf::Slice::Make(type, data, window, size, size * width);
    };
    Imf::FrameBuffer buffer;
    buffer.insert("A", slice(Imf::HALF, halves.data(), 2));
    buffer.insert("Y", kind.type == Imf::HALF    ? slice(kind.type, halves.data(), 2)
                       : kind.type == Imf::FLOAT ? slice(kind.type, floats.data(), 4)
                                                 : slice(kind.type, integers.data(), 4));
    if (kind.tile == 0) {
        Imf::OutputFile file(path.c_str(), header, 0);
        file.setFrameBuffer(buffer);
        file.writePixels(extent.height);
        return;
    }
    header.setTileDescription(
        Imf::TileDescription(static_cast<unsigned>(kind.tile), static_cast<unsigned>(kind.tile), Imf::ONE_LEVEL));
    Imf::TiledOutputFile file(path.c_str(), header, 0);
    file.setFrameBuffer(buffer);
    file.writeTiles(0, file.numXTiles() - 1, 0, file.numYTiles() - 1);
}

inline void append(png_structp png, png_bytep data, std::size_t count) {
    auto* bytes = static_cast<Bytes*>(png_get_io_ptr(png));
    const auto* from = reinterpret_cast<const std::byte*>(data);
    bytes->insert(bytes->end(), from, from + count);
}

struct Kind {
    int channels = 1;
    int bits = 8;
    bool interlaced = false;
};

// Bumps with noise.
inline Bytes make_png(Extent extent, const Kind& kind = {}, unsigned seed = 1) {
    constexpr int kColors[] = {PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_GRAY_ALPHA, PNG_COLOR_TYPE_RGB, PNG_COLOR_TYPE_RGBA};
    Bytes bytes;
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(png);
    png_set_write_fn(png, &bytes, append, nullptr);
    png_set_compression_level(png, 1);
    png_set_IHDR(png, info, static_cast<png_uint_32>(extent.width), static_cast<png_uint_32>(extent.height), kind.bits,
                 kColors[kind.channels - 1], kind.interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE, 0, 0);
    png_write_info(png, info);
    std::mt19937 random(seed);
    std::vector<std::vector<png_byte>> rows;
    std::vector<png_bytep> pointers;
    for (int j = 0; j < extent.height; ++j) {
        std::vector<png_byte>& row = rows.emplace_back();
        for (int i = 0; i < extent.width * kind.channels; ++i) {
            const auto bump = static_cast<unsigned>(100.0 + 80.0 * std::sin(0.11 * i) * std::cos(0.07 * j));
            row.push_back(static_cast<png_byte>(bump + random() % 20));
            if (kind.bits == 16) row.push_back(static_cast<png_byte>(random()));
        }
    }
    for (std::vector<png_byte>& row : rows) pointers.push_back(row.data());
    png_write_image(png, pointers.data());
    png_write_end(png, info);
    png_destroy_write_struct(&png, &info);
    return bytes;
}

class Pipeline : public StreamTest {
protected:
    Pipeline() {
        options_.write.sync = false;
        options_.pack.effort = Effort::fast;
    }

    // The picture, in linear values.
    [[nodiscard]] Image linear(const std::string& input) const {
        Image image = read_image(input).value();
        if (options_.color.space.empty()) return image;
        return to_linear(std::move(image), options_.color).value();
    }

    // The result of calling the verbs on a picture one after the other.
    [[nodiscard]] Bytes by_verbs(const std::string& input, Container container, SlopeRange* slopes = nullptr) const {
        auto field = height_field(linear(input), options_.heights).value();
        const Strength strength = options_.strength ? options_.strength(field.height.extent()) : Strength();
        field.bumpiness_x = strength.x;
        field.bumpiness_y = strength.y;
        NormalMap normals = bake(field, options_.bake).value();
        const MipChain chain = build_mip_chain(std::move(normals), options_.mip).value();
        if (slopes != nullptr) *slopes = slope_range(chain.levels.front());
        return encode_file(pack(chain, options_.pack).value(), container, options_.write).value();
    }

    // Streams a picture in small pieces.
    Result<BakeFileReport> stream(const std::string& input, Container container, int threads, const StreamSizes& sizes,
                                  std::function<bool(double)> progress = {}) const {
        Result<InputFile> file = InputFile::open(input);
        if (!file) return file.error();
        return bake_stream(*file, path("out"), container, options_, {threads, std::move(progress)}, sizes);
    }

    BakeFileOptions options_;
};

}  // namespace tex
