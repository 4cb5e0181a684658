// SPDX-License-Identifier: Apache-2.0
// height_maps.h: fractal height maps as files, and the minimum cost of reading them.

#pragma once

#include <png.h>

#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include <ImfArray.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfThreading.h>
#include <half.h>

namespace bench {

// The period of the heights, in texels. It is longer than the 32 KB that deflate looks back, as in a photograph, even
// in rows of the smallest maps.
inline constexpr int kPeriod = 4096;

// The ratio of each octave to the previous one. 8-bit files of 4096x4096 take 3 MB, 16-bit ones 23 MB.
inline constexpr double kRoughness = 0.65;

// Nine octaves of smooth noise, in [0, 1]; tiles at multiples of kPeriod.
inline double fractal(int i, int j, int octaves = 9) {
    const auto lattice = [](std::uint32_t x, std::uint32_t y, std::uint32_t octave) {
        std::uint32_t h = x * 0x9e3779b1u ^ y * 0x85ebca77u ^ octave * 0xc2b2ae3du;
        h = (h ^ (h >> 15)) * 0x2c1b3c6du;
        h = (h ^ (h >> 12)) * 0x297a2d39u;
        return static_cast<double>((h ^ (h >> 15)) >> 8) / 16777216.0;
    };
    double sum = 0.0, most = 0.0;
    double amplitude = 1.0;
    for (int k = 0; k < octaves; ++k, amplitude *= kRoughness) {
        most += amplitude;
        const int cell = 1024 >> k;
        const auto cells = static_cast<std::uint32_t>(kPeriod / cell);
        const double u = static_cast<double>(i % cell) / cell;
        const double v = static_cast<double>(j % cell) / cell;
        const double su = u * u * (3.0 - 2.0 * u);
        const double sv = v * v * (3.0 - 2.0 * v);
        const auto x = static_cast<std::uint32_t>(i / cell) % cells;
        const auto y = static_cast<std::uint32_t>(j / cell) % cells;
        const auto octave = static_cast<std::uint32_t>(k);
        const double top = lattice(x, y, octave) * (1.0 - su) + lattice((x + 1) % cells, y, octave) * su;
        const double low =
            lattice(x, (y + 1) % cells, octave) * (1.0 - su) + lattice((x + 1) % cells, (y + 1) % cells, octave) * su;
        sum += amplitude * (top * (1.0 - sv) + low * sv);
    }
    return sum / most;
}

// The heights of a tile, computed once.
inline float height(int i, int j) {
    static const std::vector<float> tile = [] {
        std::vector<float> values;
        values.reserve(static_cast<std::size_t>(kPeriod) * kPeriod);
        for (int y = 0; y < kPeriod; ++y) {
            for (int x = 0; x < kPeriod; ++x) values.push_back(static_cast<float>(fractal(x, y)));
        }
        return values;
    }();
    return tile[static_cast<std::size_t>((j & (kPeriod - 1)) * kPeriod + (i & (kPeriod - 1)))];
}

inline void write_png(const std::string& path, int width, int height_of, int bits, int dx = 0) {
    std::FILE* file = std::fopen(path.c_str(), "wb");
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(png);
    png_init_io(png, file);
    png_set_user_limits(png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
    png_set_compression_level(png, 6);
    png_set_IHDR(png, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height_of), bits,
                 PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_NONE, 0, 0);
    png_write_info(png, info);
    std::vector<png_byte> row(static_cast<std::size_t>(width * bits / 8));
    for (int j = 0; j < height_of; ++j) {
        for (int i = 0; i < width; ++i) {
            const auto code = static_cast<unsigned>(height(i + dx, j) * static_cast<float>((1 << bits) - 1));
            png_byte* to = row.data() + static_cast<std::ptrdiff_t>(i) * (bits / 8);
            if (bits == 16) *to++ = static_cast<png_byte>(code >> 8);
            *to = static_cast<png_byte>(code);
        }
        png_write_row(png, row.data());
    }
    png_write_end(png, info);
    png_destroy_write_struct(&png, &info);
    std::fclose(file);
}

// In half precision.
inline void write_exr(const std::string& path, int width, int height_of,
                      Imf::Compression compression = Imf::ZIP_COMPRESSION) {
    Imf::Header header(width, height_of);
    header.compression() = compression;
    header.channels().insert("Y", Imf::Channel(Imf::HALF));
    Imf::OutputFile file(path.c_str(), header, 0);
    std::vector<Imath::half> row(static_cast<std::size_t>(width));
    for (int j = 0; j < height_of; ++j) {
        for (int i = 0; i < width; ++i) row[static_cast<std::size_t>(i)] = Imath::half(height(i, j));
        Imf::FrameBuffer buffer;
        buffer.insert("Y", Imf::Slice(Imf::HALF, reinterpret_cast<char*>(row.data()), sizeof(Imath::half), 0));
        file.setFrameBuffer(buffer);
        file.writePixels(1);
    }
}

// The cost of reading alone: libpng decodes, and the rows are discarded.
inline int decode_png(const char* path) {
    std::FILE* file = std::fopen(path, "rb");
    if (file == nullptr) return 1;
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(png);
    png_init_io(png, file);
    png_set_user_limits(png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
    png_read_info(png, info);
    std::vector<png_byte> row(png_get_rowbytes(png, info));
    const png_uint_32 rows = png_get_image_height(png, info);
    for (png_uint_32 j = 0; j < rows; ++j) png_read_row(png, row.data(), nullptr);
    png_read_end(png, nullptr);
    png_destroy_read_struct(&png, &info, nullptr);
    std::fclose(file);
    return 0;
}

// OpenEXR reads the whole picture in its stored type, with its own threads.
inline int decode_exr(const char* path, int threads) {
    Imf::setGlobalThreadCount(threads);
    Imf::InputFile file(path, threads);
    const Imath::Box2i window = file.header().dataWindow();
    const int width = window.max.x - window.min.x + 1;
    Imf::Array2D<Imath::half> values(window.max.y - window.min.y + 1, width);
    Imf::FrameBuffer buffer;
    buffer.insert("Y", Imf::Slice(Imf::HALF, reinterpret_cast<char*>(&values[0][0]), sizeof(Imath::half),
                                  sizeof(Imath::half) * static_cast<std::size_t>(width)));
    file.setFrameBuffer(buffer);
    file.readPixels(window.min.y, window.max.y);
    return 0;
}

}  // namespace bench
