// SPDX-License-Identifier: Apache-2.0

#include "preview/legend.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

#include "preview/canvas.h"

namespace tex::inline v1::render {
namespace {

// In pixels, times text_scale().
constexpr int kMargin = 8;
constexpr int kBarTop = 6;
constexpr int kBarHeight = 10;
constexpr int kTextTop = 21;
constexpr int kLineRows = 12;  // of a line of the title below the values
constexpr int kLeastWidth = 96;
constexpr int kKeyRows = 18;
constexpr int kKeyTop = 5;

// Nobody can distinguish this many colours. Together with the colours of the letters, they fit into the palette of a
// PNG.
constexpr double kColorSteps = 240.0;

// Breaks the title at blanks into lines of at most `width` pixels, so that no figure is cut.
std::vector<std::string> lines_of(const std::string& title, int unit, int width) {
    std::vector<std::string> lines;
    for (std::size_t at = 0; at < title.size();) {
        const std::size_t end = std::min(title.find(' ', at), title.size());
        const std::string word = fitted(std::string_view(title).substr(at, end - at), unit, width);
        at = end + 1;
        if (!lines.empty() && text_width(lines.back() + " " + word, unit) <= width) {
            lines.back() += " " + word;
        } else {
            lines.push_back(word);
        }
    }
    return lines;
}

}  // namespace

Vec3 ColorScale::color(double value) const {
    const double range = greatest - least;
    double t = (value - least) / (range > 0.0 ? range : 1.0);
    if (palette != Palette::grey && t > 0.0 && t < 1.0) t = std::floor(t * kColorSteps + 0.5) / kColorSteps;
    switch (palette) {
        case Palette::viridis: return viridis(t);
        case Palette::diverging: return diverging(2.0 * t - 1.0);
        case Palette::grey: return Vec3{1.0, 1.0, 1.0} * t;
        case Palette::inferno: return inferno(t);
    }
    return {};
}

std::string number(double value) {
    char text[32];
    const auto end = std::to_chars(text, text + sizeof text, value, std::chars_format::general, 3);
    return {text, end.ptr};
}

Level legend(int width, int unit, const ColorScale& scale, Title place) {
    const std::string left = number(scale.least), right = number(scale.greatest);
    const int side = std::max(text_width(left, unit), text_width(right, unit)) + 2 * kMargin * unit;
    const int between = width - 2 * side;
    std::vector<std::string> lines;
    if (place == Title::may_be_below && text_width(scale.title, unit) > between)
        lines = lines_of(scale.title, unit, width - 2 * kMargin * unit);
    Canvas canvas(Extent{width, (kLegendRows + kLineRows * static_cast<int>(lines.size())) * unit});
    const int bar = std::max(1, width - 2 * kMargin * unit);
    for (int i = 0; i < bar; ++i) {
        const Vec3 color = scale.color(scale.least + (scale.greatest - scale.least) *
                                                         (bar > 1 ? static_cast<double>(i) / (bar - 1) : 0.0));
        canvas.fill((width - bar) / 2 + i, kBarTop * unit, {1, kBarHeight * unit},
                    {display_code(color.x), display_code(color.y), display_code(color.z)});
    }
    int y = kTextTop * unit;
    canvas.text(kMargin * unit, y, unit, left);
    canvas.text(width - kMargin * unit - text_width(right, unit), y, unit, right);
    const auto put = [&](const std::string& line) { canvas.text((width - text_width(line, unit)) / 2, y, unit, line); };
    if (lines.empty()) put(fitted(scale.title, unit, between));
    for (const std::string& line : lines) {
        y += kLineRows * unit;
        put(line);
    }
    return std::move(std::move(canvas).take().levels.front());
}

Texture with_legend(Texture picture, const ColorScale& scale) {
    const Level& level = picture.levels.front();
    const int width = std::max(level.extent.width, kLeastWidth), top = level.extent.height;
    const Level below = legend(width, text_scale(width), scale, Title::may_be_below);
    Canvas canvas({width, top + below.extent.height});
    canvas.draw(0, 0, level);
    canvas.draw(0, top, below);
    return std::move(canvas).take();
}

Texture with_key(Texture picture, const std::vector<Keyword>& words) {
    const Level& level = picture.levels.front();
    const int width = std::max(level.extent.width, kLeastWidth), top = level.extent.height, unit = text_scale(width);
    Canvas canvas({width, top + kKeyRows * unit});
    canvas.draw(0, 0, level);
    const int margin = kMargin * unit, count = static_cast<int>(words.size());
    int x = margin;
    for (int k = 0; k < count; ++k) {
        const Keyword& key = words[static_cast<std::size_t>(k)];
        const std::string word = fitted(key.word, unit, (width - margin - x) / (count - k) - margin);
        canvas.text(x, top + kKeyTop * unit, unit, word, key.color);
        x += text_width(word, unit) + 2 * margin;
    }
    return std::move(canvas).take();
}

}  // namespace tex::inline v1::render
