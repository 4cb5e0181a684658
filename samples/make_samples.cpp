// SPDX-License-Identifier: Apache-2.0
// make_samples: writes the sample height maps of this folder, from formulas.
//
//     make_samples FOLDER
//
//     hemisphere.png  256x256, 16 bits   a half ball of radius 112 texels: --bumpiness 112 gives its true normals
//     waves.png       128x128, 16 bits   crossing sines; tiles
//     bricks.png      512x512, 16 bits   a brick wall with worn edges and mortar; tiles (uses 11 bits: a smaller file)
//     ramp.png         64x64,   8 bits   four codes a column: a constant slope
//     dunes.png       256x256,  8 bits   low smooth hills: each code is a terrace
//
// Uses only + - * / and sqrt in double, so that every machine writes the same bytes. A test compares them with the
// committed files.

#include <png.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

namespace {

// Codes of `bits` bits, row by row from the top.
struct Grey {
    int width;
    int height;
    int bits;
    std::vector<std::uint16_t> codes;

    Grey(int w, int h, int b)
        : width(w), height(h), bits(b), codes(static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {}
    std::uint16_t& at(int i, int j) {
        return codes[static_cast<std::size_t>(j) * static_cast<std::size_t>(width) + static_cast<std::size_t>(i)];
    }
    // Height 1 is the largest code. Codes are multiples of `step`.
    void set(int i, int j, double height01, int step = 1) {
        const int most = (bits == 8 ? 255 : 65535) / step;
        at(i, j) = static_cast<std::uint16_t>(static_cast<int>(std::clamp(height01, 0.0, 1.0) * most + 0.5) * step);
    }
};

bool write_png(const std::string& path, Grey& grey) {
    std::FILE* file = std::fopen(path.c_str(), "wb");
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;
    if (file == nullptr || info == nullptr || setjmp(png_jmpbuf(png)) != 0) {
        std::fprintf(stderr, "make_samples: error: %s: cannot be written\n", path.c_str());
        return false;
    }
    png_init_io(png, file);
    png_set_compression_level(png, 9);
    png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_ALL_FILTERS);
    png_set_IHDR(png, info, static_cast<png_uint_32>(grey.width), static_cast<png_uint_32>(grey.height), grey.bits,
                 PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_BASE, PNG_FILTER_TYPE_BASE);
    png_write_info(png, info);
    std::vector<png_byte> row(static_cast<std::size_t>(grey.width) * 2);
    for (int j = 0; j < grey.height; ++j) {
        std::size_t next = 0;
        for (int i = 0; i < grey.width; ++i) {
            if (grey.bits == 16) row[next++] = static_cast<png_byte>(grey.at(i, j) >> 8);
            row[next++] = static_cast<png_byte>(grey.at(i, j) & 255);
        }
        png_write_row(png, row.data());
    }
    png_write_end(png, nullptr);
    png_destroy_write_struct(&png, &info);
    return std::fclose(file) == 0;
}

Grey hemisphere() {
    Grey grey(256, 256, 16);
    constexpr double kRadius = 112.0;
    for (int j = 0; j < 256; ++j) {
        for (int i = 0; i < 256; ++i) {
            const double x = (i + 0.5 - 128.0) / kRadius;
            const double y = (j + 0.5 - 128.0) / kRadius;
            grey.set(i, j, std::sqrt(std::max(0.0, 1.0 - x * x - y * y)));
        }
    }
    return grey;
}

Grey waves() {
    constexpr int kSize = 128;
    // sin(2 pi k / 128) by rotating a vector. The rotation's cosine and sine come from halving the right angle five
    // times.
    double c = 0.0;
    for (int halving = 0; halving < 5; ++halving) c = std::sqrt((1.0 + c) / 2.0);
    const double s = std::sqrt(1.0 - c * c);
    std::vector<double> sine(kSize);
    double x = 1.0;
    double y = 0.0;
    for (double& value : sine) {
        value = y;
        const double turned = x * c - y * s;
        y = x * s + y * c;
        x = turned;
    }
    const auto at = [&](int k) { return sine[static_cast<std::size_t>(k & (kSize - 1))]; };
    Grey grey(kSize, kSize, 16);
    for (int j = 0; j < kSize; ++j) {
        for (int i = 0; i < kSize; ++i) {
            const double sum = at(2 * i + j) + 0.6 * at(3 * j - i + 20) + 0.3 * at(5 * i + 4 * j + 45);
            grey.set(i, j, 0.5 + sum / 3.8);
        }
    }
    return grey;
}

Grey ramp() {
    Grey grey(64, 64, 8);
    for (int j = 0; j < 64; ++j) {
        for (int i = 0; i < 64; ++i) grey.at(i, j) = static_cast<std::uint16_t>(4 * i);
    }
    return grey;
}

// A number in [0, 1) from two integers and a seed.
double random01(std::uint32_t i, std::uint32_t j, std::uint32_t seed) {
    std::uint32_t h = i * 0x9E3779B1u ^ j * 0x85EBCA77u ^ seed * 0xC2B2AE3Du;
    h = (h ^ (h >> 15)) * 0x2C1B3C6Du;
    h = (h ^ (h >> 12)) * 0x297A2D39u;
    return static_cast<double>((h ^ (h >> 15)) >> 8) / 16777216.0;
}

double smooth(double t) { return t * t * (3.0 - 2.0 * t); }

constexpr int kWall = 512;

// Value noise in [-1, 1] on a lattice of `cell` texels that tiles with the wall.
double noise(int i, int j, int cell, std::uint32_t seed) {
    const int cells = kWall / cell;
    const auto corner = [&](int a, int b) {
        return 2.0 * random01(static_cast<std::uint32_t>(a % cells), static_cast<std::uint32_t>(b % cells), seed) - 1.0;
    };
    const int a = i / cell;
    const int b = j / cell;
    const double u = smooth(static_cast<double>(i % cell) / cell);
    const double v = smooth(static_cast<double>(j % cell) / cell);
    const double top = corner(a, b) + (corner(a + 1, b) - corner(a, b)) * u;
    const double bottom = corner(a, b + 1) + (corner(a + 1, b + 1) - corner(a, b + 1)) * u;
    return top + (bottom - top) * v;
}

// Running bond: 8 courses of 4 bricks, every second course moved by half a brick.
double brick_height(int i, int j) {
    constexpr int kLength = 128;
    constexpr int kCourse = 64;
    constexpr double kJoint = 5.0;   // half the width of the mortar, texels
    constexpr double kCorner = 7.0;  // radius of a brick's corners
    constexpr double kBevel = 9.0;   // width of the rounded edge

    const int course = j / kCourse;
    const int shifted = (i + (course % 2) * (kLength / 2)) % kWall;
    const auto id = static_cast<std::uint32_t>(course * 4 + shifted / kLength);
    const double x = shifted % kLength + 0.5 - kLength / 2.0;
    const double y = j % kCourse + 0.5 - kCourse / 2.0;

    // How far the texel is inside the worn outline of its brick: the distance to a rounded rectangle.
    const double wear = 1.6 * noise(i, j, 16, 1) + 0.9 * noise(i, j, 8, 2);
    const double dx = std::abs(x) - (kLength / 2.0 - kJoint - kCorner);
    const double dy = std::abs(y) - (kCourse / 2.0 - kJoint - kCorner);
    const double outside_x = std::max(dx, 0.0);
    const double outside_y = std::max(dy, 0.0);
    const double outside = std::sqrt(outside_x * outside_x + outside_y * outside_y);
    const double inside = kCorner - outside - std::min(std::max(dx, dy), 0.0) + wear;
    const double edge = std::clamp(inside / kBevel, 0.0, 1.0);

    const double mortar = 0.22 + 0.035 * noise(i, j, 8, 3) + 0.02 * noise(i, j, 4, 4);
    if (edge <= 0.0) return mortar;
    const double tilt = 0.06 * ((random01(id, 1, 5) - 0.5) * x / kLength + (random01(id, 2, 5) - 0.5) * y / kCourse);
    const double face = 0.80 + 0.12 * (random01(id, 3, 5) - 0.5) + tilt + 0.03 * noise(i, j, 32, 6) +
                        0.022 * noise(i, j, 8, 7) + 0.01 * noise(i, j, 4, 8);
    const double round = std::sqrt(edge * (2.0 - edge));  // a quarter of a circle
    return std::max(mortar, mortar + (face - mortar) * round);
}

Grey bricks() {
    Grey grey(kWall, kWall, 16);
    for (int j = 0; j < kWall; ++j) {
        for (int i = 0; i < kWall; ++i) grey.set(i, j, brick_height(i, j), 32);
    }
    return grey;
}

Grey dunes() {
    Grey grey(256, 256, 8);
    for (int j = 0; j < 256; ++j) {
        for (int i = 0; i < 256; ++i) grey.set(i, j, 0.5 + 0.25 * noise(i, j, 64, 9) + 0.05 * noise(i, j, 32, 10));
    }
    return grey;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fprintf(stderr, "usage: make_samples FOLDER\n");
        return 2;
    }
    struct Sample {
        const char* name;
        Grey grey;
    };
    Sample samples[] = {{"hemisphere.png", hemisphere()},
                        {"waves.png", waves()},
                        {"bricks.png", bricks()},
                        {"ramp.png", ramp()},
                        {"dunes.png", dunes()}};
    for (Sample& sample : samples) {
        if (!write_png(std::string(argv[1]) + "/" + sample.name, sample.grey)) return 3;
    }
    return 0;
}
