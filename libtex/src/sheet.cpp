// SPDX-License-Identifier: Apache-2.0

#include <tex/preview.h>

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <set>
#include <string_view>
#include <utility>

#include "formats/png/apng.h"
#include "formats/png/png.h"
#include "preview/canvas.h"
#include "threads/no_throw.h"

namespace tex::inline v1 {
namespace {

using render::Canvas;

constexpr std::size_t kPaletteSize = 256;  // of a PNG
constexpr int kGap = 8;
constexpr render::Code kEmptyCell{54, 57, 63};
constexpr int kCaption = 14;  // height of a line of the caption, times the scale of the letters

int columns_for(std::size_t count) {
    int columns = 1;
    while (static_cast<std::size_t>(columns) * static_cast<std::size_t>(columns) < count) ++columns;
    return columns;
}

// The size of empty cells.
Extent largest_picture(const std::vector<Panel>& panels) {
    constexpr Extent kIfThereIsNone{320, 320};
    Extent largest{0, 0};
    for (const Panel& panel : panels) {
        if (panel.picture.levels.empty()) continue;
        largest.width = std::max(largest.width, panel.picture.extent().width);
        largest.height = std::max(largest.height, panel.picture.extent().height);
    }
    return largest.width > 0 ? largest : kIfThereIsNone;
}

// Writes words into a cell, in as many lines as it has room for.
void draw_note(Canvas& canvas, int x, int y, Extent cell, int scale, std::string_view words) {
    const int margin = 2 * kGap, advance = (render::kGlyphHeight + 4) * scale, width = cell.width - 2 * margin;
    canvas.fill(x, y, cell, kEmptyCell);
    std::string line;
    for (int top = y + margin; !words.empty() && top + advance <= y + cell.height; top += advance) {
        for (line.clear(); !words.empty();) {
            const std::size_t end = std::min(words.find(' '), words.size());
            const std::string longer = (line.empty() ? line : line + ' ') + std::string(words.substr(0, end));
            if (!line.empty() && render::text_width(longer, scale) > width) break;
            line = longer;
            words.remove_prefix(std::min(end + 1, words.size()));
        }
        canvas.text(x + margin, top, scale, render::fitted(line, scale, width));
    }
}

bool without_captions(const std::vector<Panel>& panels) {
    return std::all_of(panels.begin(), panels.end(), [](const Panel& panel) { return panel.caption.empty(); });
}

}  // namespace

Result<Texture> picture_of(const Image& image) {
    return no_throw([&]() -> Result<Texture> {
        const Plane<float>* planes[3] = {};
        for (int c = 0; c < 3; ++c) {
            const int index = image.find(std::string(1, "RGB"[c]));
            if (index < 0) return Error{ErrorCode::bad_option, {}, "the picture has no channels R, G and B"};
            planes[c] = &image.planes[static_cast<std::size_t>(index)];
        }
        Canvas canvas(image.extent());
        for (int j = 0; j < image.extent().height; ++j) {
            for (int i = 0; i < image.extent().width; ++i) {
                const auto code = [&](int c) { return render::display_code(static_cast<double>(planes[c]->at(i, j))); };
                canvas.set(i, j, {code(0), code(1), code(2)});
            }
        }
        return std::move(canvas).take();
    });
}

Result<std::vector<std::byte>> encode_picture(const Texture& picture) {
    return no_throw([&]() -> Result<std::vector<std::byte>> {
        if (picture.levels.empty()) return Error{ErrorCode::bad_option, {}, "the picture has no level"};
        const Level& level = picture.levels.front();
        const auto count = static_cast<std::size_t>(level.extent.texels());
        const auto* bytes = reinterpret_cast<const std::uint8_t*>(level.bytes.data());
        const auto color = [&](std::size_t k) { return PngColor{bytes[3 * k], bytes[3 * k + 1], bytes[3 * k + 2]}; };

        std::set<PngColor> colors;
        bool is_grey = true;
        for (std::size_t k = 0; k < count && (is_grey || colors.size() <= kPaletteSize); ++k) {
            const PngColor c = color(k);
            is_grey = is_grey && c.r == c.g && c.g == c.b;
            if (colors.size() <= kPaletteSize) colors.insert(c);
        }
        if (!is_grey && colors.size() > kPaletteSize) return encode_png(picture);

        Texture narrow;
        narrow.format = Format::r8_unorm;
        narrow.levels.push_back({level.extent, std::vector<std::byte>(count)});
        const std::vector<PngColor> palette(colors.begin(), colors.end());
        for (std::size_t k = 0; k < count; ++k) {
            const auto place = std::lower_bound(palette.begin(), palette.end(), color(k)) - palette.begin();
            narrow.levels.front().bytes[k] = is_grey ? level.bytes[3 * k] : static_cast<std::byte>(place);
        }
        return is_grey ? encode_png(narrow) : encode_indexed_png(narrow.levels.front(), palette);
    });
}

Result<Texture> contact_sheet(const std::vector<Panel>& panels, int columns) {
    return no_throw([&]() -> Result<Texture> {
        if (panels.empty()) return Error{ErrorCode::bad_option, {}, "a sheet needs at least one picture"};
        if (columns <= 0) columns = columns_for(panels.size());
        columns = std::min(columns, static_cast<int>(panels.size()));
        const int rows = (static_cast<int>(panels.size()) + columns - 1) / columns;
        const Extent empty = largest_picture(panels);
        const auto extent_of = [&](const Panel& panel) {
            return panel.picture.levels.empty() ? empty : panel.picture.extent();
        };
        std::vector<int> widths(static_cast<std::size_t>(columns)), heights(static_cast<std::size_t>(rows));
        for (std::size_t k = 0; k < panels.size(); ++k) {
            const Extent extent = extent_of(panels[k]);
            int& width = widths[k % static_cast<std::size_t>(columns)];
            int& height = heights[k / static_cast<std::size_t>(columns)];
            width = std::max(width, extent.width);
            height = std::max(height, extent.height);
        }
        const int scale = render::text_scale(*std::max_element(widths.begin(), widths.end()));
        const int caption = without_captions(panels) ? 0 : kCaption * scale;
        Canvas canvas({std::accumulate(widths.begin(), widths.end(), kGap * (columns + 1)),
                       std::accumulate(heights.begin(), heights.end(), (kGap + caption) * rows + kGap)});
        int y = kGap;
        for (int row = 0; row < rows; ++row) {
            int x = kGap;
            for (int column = 0; column < columns; ++column) {
                const std::size_t k = static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                                      static_cast<std::size_t>(column);
                if (k >= panels.size()) break;
                const Panel& panel = panels[k];
                const int width = widths[static_cast<std::size_t>(column)];
                const Extent extent = extent_of(panel);
                if (panel.picture.levels.empty()) {
                    draw_note(canvas, x, y, extent, scale, panel.note);
                } else {
                    canvas.draw(x, y, panel.picture.levels.front());
                }
                canvas.text(x, y + extent.height + 4 * scale, scale, render::fitted(panel.caption, scale, width));
                x += width + kGap;
            }
            y += heights[static_cast<std::size_t>(row)] + caption + kGap;
        }
        return std::move(canvas).take();
    });
}

Result<Texture> split_view(const Panel& left, const Panel& right) {
    return no_throw([&]() -> Result<Texture> {
        const Extent extent = left.picture.extent();
        if (extent == Extent{}) return Error{ErrorCode::bad_option, {}, "a split view needs two pictures"};
        if (extent != right.picture.extent())
            return Error{ErrorCode::bad_option, {}, "the two pictures differ in size"};
        const int scale = render::text_scale(extent.width), middle = extent.width / 2;
        Canvas canvas({extent.width, extent.height + kCaption * scale + 4 * scale});
        canvas.draw_columns(0, 0, left.picture.levels.front(), 0, middle);
        canvas.draw_columns(0, 0, right.picture.levels.front(), middle, extent.width);
        canvas.fill(middle - scale, 0, {2 * scale, extent.height}, render::kInk);
        const int y = extent.height + 5 * scale, margin = 4 * scale;
        const std::string a = render::fitted(left.caption, scale, middle - 2 * margin);
        const std::string b = render::fitted(right.caption, scale, extent.width - middle - 2 * margin);
        canvas.text(margin, y, scale, a);
        canvas.text(extent.width - margin - render::text_width(b, scale), y, scale, b);
        return std::move(canvas).take();
    });
}

Result<std::vector<std::byte>> encode_animation(const std::vector<Texture>& pictures, int frames_per_second) {
    return no_throw([&]() -> Result<std::vector<std::byte>> {
        if (pictures.empty()) return Error{ErrorCode::bad_option, {}, "an animation needs at least one picture"};
        std::vector<std::vector<std::byte>> frames;
        for (const Texture& picture : pictures) {
            auto frame = encode_png(picture);
            if (!frame) return frame.error();
            frames.push_back(std::move(*frame));
        }
        return join_png_frames(frames, std::clamp(frames_per_second, 1, 1000));
    });
}

}  // namespace tex::inline v1
