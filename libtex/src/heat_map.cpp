// SPDX-License-Identifier: Apache-2.0

#include <tex/heat_map.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>

#include "base/guard.h"
#include "base/parallel.h"

namespace tex {
namespace {

constexpr int kRowsPerPiece = 16;

using Color = std::array<float, 3>;

constexpr std::array<std::uint32_t, 10> kInferno = {0x000004, 0x1b0c42, 0x4b0c6b, 0x781c6d, 0xa52c60,
                                                    0xcf4446, 0xed6925, 0xfb9a06, 0xf7d03c, 0xfcffa4};

// The colour of t; outside [0, 1] that of the nearer end.
Color color_at(float t) {
    constexpr int kPieces = static_cast<int>(kInferno.size()) - 1;
    const float position = std::clamp(t, 0.0f, 1.0f) * static_cast<float>(kPieces);
    const int piece = std::min(static_cast<int>(position), kPieces - 1);
    const float rest = position - static_cast<float>(piece);
    Color color{};
    for (std::size_t c = 0; c < 3; ++c) {
        const auto channel = [&](int k) {
            return static_cast<float>(kInferno[static_cast<std::size_t>(k)] >> (16 - 8 * c) & 0xff) / 255.0f;
        };
        color[c] = channel(piece) + (channel(piece + 1) - channel(piece)) * rest;
    }
    return color;
}

// A font of 3x5 dots, each row three bits with the left dot first.
constexpr std::string_view kGlyphs = "0123456789.o";  // o is the degree sign
constexpr std::array<std::array<std::uint8_t, 5>, 12> kFont = {{{7, 5, 5, 5, 7},
                                                                 {2, 6, 2, 2, 7},
                                                                 {7, 1, 7, 4, 7},
                                                                 {7, 1, 7, 1, 7},
                                                                 {5, 5, 7, 1, 1},
                                                                 {7, 4, 7, 1, 7},
                                                                 {7, 4, 7, 5, 7},
                                                                 {7, 1, 1, 2, 2},
                                                                 {7, 5, 7, 5, 7},
                                                                 {7, 5, 7, 1, 7},
                                                                 {0, 0, 0, 0, 2},
                                                                 {2, 5, 2, 0, 0}}};
constexpr int kDot = 2;                // texels along a dot of the font
constexpr int kGlyphWidth = 4 * kDot;  // three dots and a gap
constexpr int kBarTop = 4;
constexpr int kBarRows = 8;
constexpr int kTextTop = kBarTop + kBarRows + 2;
static_assert(kTextTop + 5 * kDot <= kHeatMapLegendRows);

// "7.5o": at most three decimals, without zeros at the end.
std::string label(double degrees) {
    const auto thousandths = static_cast<int>(std::floor(degrees * 1000.0 + 0.5));
    std::string decimals = std::to_string(1000 + thousandths % 1000).substr(1);
    while (!decimals.empty() && decimals.back() == '0') decimals.pop_back();
    return std::to_string(thousandths / 1000) + (decimals.empty() ? "" : "." + decimals) + "o";
}

void set(Image& image, int i, int j, const Color& color) {
    for (std::size_t c = 0; c < 3; ++c) image.planes[c].at(i, j) = color[c];
}

void draw_text(Image& image, std::string_view text, int left, int top) {
    for (std::size_t k = 0; k < text.size(); ++k, left += kGlyphWidth) {
        const auto& glyph = kFont[kGlyphs.find(text[k])];
        for (int j = 0; j < 5 * kDot; ++j) {
            for (int i = 0; i < 3 * kDot; ++i) {
                const int dots = glyph[static_cast<std::size_t>(j / kDot)];
                if ((dots >> (2 - i / kDot) & 1) != 0) set(image, left + i, top + j, {1.0f, 1.0f, 1.0f});
            }
        }
    }
}

void draw_legend(Image& image, double full_scale) {
    const int width = image.extent().width;
    const int top = image.extent().height - kHeatMapLegendRows;
    for (int i = 0; i < width; ++i) {
        const Color color = color_at((static_cast<float>(i) + 0.5f) / static_cast<float>(width));
        for (int j = 0; j < kBarRows; ++j) set(image, i, top + kBarTop + j, color);
    }
    const auto write = [&](double value, double place) {
        const std::string text = label(value);
        const int length = static_cast<int>(text.size()) * kGlyphWidth - kDot;
        draw_text(image, text, static_cast<int>(place * (width - length)), top + kTextTop);
    };
    write(0.0, 0.0);
    write(full_scale / 2.0, 0.5);
    write(full_scale, 1.0);
}

}  // namespace

Result<Image> heat_map(const Plane<float>& degrees, double full_scale, const Execution& execution) {
    assert(!degrees.empty() && full_scale > 0.0 && full_scale <= 180.0);
    return guarded([&]() -> Result<Image> {
        const Extent map = degrees.extent();
        const Extent extent{std::max(map.width, kHeatMapLeastWidth), map.height + kHeatMapLegendRows};
        Image image;
        for (const char* name : {"R", "G", "B"}) {
            image.planes.emplace_back(extent, 0.0f);
            image.names.emplace_back(name);
        }
        const auto scale = static_cast<float>(1.0 / full_scale);
        const auto body = [&](int begin, int end) {
            for (int j = begin; j < end; ++j) {
                for (int i = 0; i < map.width; ++i) set(image, i, j, color_at(degrees.at(i, j) * scale));
            }
        };
        if (auto done = parallel_for(execution, map.height, kRowsPerPiece, body); !done) return done.error();
        draw_legend(image, full_scale);
        return image;
    });
}

Result<Plane<float>> largest_of_cells(const Plane<float>& degrees, int side) {
    return guarded([&]() -> Result<Plane<float>> {
        const Extent extent = degrees.extent();
        const int cell = (std::max(extent.width, extent.height) + side - 1) / side;
        Plane<float> cells({(extent.width + cell - 1) / cell, (extent.height + cell - 1) / cell}, 0.0f);
        for (int j = 0; j < extent.height; ++j) {
            for (int i = 0; i < extent.width; ++i) {
                float& largest = cells.at(i / cell, j / cell);
                largest = std::max(largest, degrees.at(i, j));
            }
        }
        return cells;
    });
}

}  // namespace tex
