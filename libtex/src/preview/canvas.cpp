// SPDX-License-Identifier: Apache-2.0

#include "preview/canvas.h"

#include <algorithm>
#include <cstring>
#include <utility>
#include <vector>

namespace tex::inline v1::render {
namespace {

std::size_t offset_of(const Level& level, int x, int y) {
    return (static_cast<std::size_t>(y) * static_cast<std::size_t>(level.extent.width) + static_cast<std::size_t>(x)) *
           3;
}

}  // namespace

Canvas::Canvas(Extent extent, Code ground) {
    level_.extent = extent;
    level_.bytes.resize(level_bytes(Format::rgb8_unorm, extent));
    fill(0, 0, extent, ground);
}

Canvas::Canvas(Texture picture) : level_(std::move(picture.levels.front())) {}

void Canvas::set(int x, int y, Code color) {
    if (x < 0 || y < 0 || x >= level_.extent.width || y >= level_.extent.height) return;
    std::byte* p = level_.bytes.data() + offset_of(level_, x, y);
    p[0] = std::byte{color.r};
    p[1] = std::byte{color.g};
    p[2] = std::byte{color.b};
}

void Canvas::fill(int x, int y, Extent size, Code color) {
    for (int j = 0; j < size.height; ++j) {
        for (int i = 0; i < size.width; ++i) set(x + i, y + j, color);
    }
}

void Canvas::draw(int x, int y, const Level& picture) { draw_columns(x, y, picture, 0, picture.extent.width); }

void Canvas::draw_columns(int x, int y, const Level& picture, int from, int to) {
    const int first = std::max(from, -x);
    const int last = std::min({to, picture.extent.width, level_.extent.width - x});
    if (first >= last) return;
    for (int j = std::max(0, -y); j < picture.extent.height && y + j < level_.extent.height; ++j) {
        std::memcpy(level_.bytes.data() + offset_of(level_, x + first, y + j),
                    picture.bytes.data() + offset_of(picture, first, j), static_cast<std::size_t>(last - first) * 3);
    }
}

void Canvas::text(int x, int y, int scale, std::string_view words, Code color) {
    for (const char c : words) {
        if (continues_letter(c)) continue;  // the font has ASCII alone: every other letter is one box
        const std::uint8_t* rows = glyph(c);
        for (int j = 0; j < kGlyphHeight; ++j) {
            for (int i = 0; i < kGlyphWidth; ++i) {
                if ((rows[j] >> (kGlyphWidth - 1 - i) & 1) != 0)
                    fill(x + i * scale, y + j * scale, {scale, scale}, color);
            }
        }
        x += kGlyphAdvance * scale;
    }
}

Texture Canvas::take() && {
    Texture picture;
    picture.format = Format::rgb8_unorm;
    picture.swizzle = {Component::other, Component::other, Component::other, Component::other};
    picture.srgb = true;
    picture.levels.push_back(std::move(level_));
    return picture;
}

std::string fitted(std::string_view words, int scale, int width) {
    if (text_width(words, scale) <= width) return std::string(words);
    constexpr std::string_view kCut = "..";
    const int letters = (width / scale + 1) / kGlyphAdvance - static_cast<int>(kCut.size());
    if (letters < 1) return {};
    std::vector<std::size_t> begins;  // of the letters
    for (std::size_t k = 0; k < words.size(); ++k) {
        if (!continues_letter(words[k])) begins.push_back(k);
    }
    const std::size_t first = static_cast<std::size_t>(letters) / 2;
    const std::size_t last = static_cast<std::size_t>(letters) - first;
    return std::string(words.substr(0, begins[first])).append(kCut).append(words.substr(begins[begins.size() - last]));
}

}  // namespace tex::inline v1::render
