// SPDX-License-Identifier: Apache-2.0

#include "checks/grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "blocks/extent.h"
#include "checks/median.h"

namespace tex::inline v1 {
namespace {

// Blocks of half the size are as visible half-way between the borders as at the borders, and more than at the quarters.
constexpr double kHalfStandsOut = 1.2;
constexpr double kHalfAsMuch = 0.8;
constexpr std::size_t kLeastBorders = 7;  // as 64 texels have: fewer stand out by chance

// The mean steps of one window along one axis: steps[k] is the step between line k and line k + 1.
std::vector<double> mean_steps(const Plane<float>& plane, Rect window, bool columns) {
    const int lines = columns ? window.width : window.height;
    std::vector<double> steps(static_cast<std::size_t>(std::max(0, lines - 1)), 0.0);
    for (int j = 0; j < window.height - (columns ? 0 : 1); ++j) {
        const float* row = plane.row(window.y + j) + window.x;
        const float* other = columns ? row + 1 : plane.row(window.y + j + 1) + window.x;
        for (int i = 0; i < window.width - (columns ? 1 : 0); ++i) {
            const double step = std::abs(static_cast<double>(row[i]) - other[i]);
            // NaN compares false: another rule checks such texels.
            if (step < 1e6) steps[static_cast<std::size_t>(columns ? i : j)] += step;
        }
    }
    return steps;
}

// Divides by the median elsewhere, or, if `by_largest`, by the largest of the medians at each place within blocks.
double axis_ratio(const Plane<float>& plane, const std::vector<Rect>& windows, int block, bool columns,
                  bool by_largest) {
    std::vector<double> at_borders, elsewhere, half_way, quarter_way;
    std::vector<std::vector<double>> by_phase(static_cast<std::size_t>(block));
    for (const Rect& window : windows) {
        const std::vector<double> steps = mean_steps(plane, window, columns);
        double sum = 0.0;
        for (const double step : steps) sum += step;
        // Steps below this count as none, compared with the map's usual steps.
        const double floor = steps.empty() ? 0.0 : 0.02 * sum / static_cast<double>(steps.size());
        if (!(floor > 0.0)) continue;
        for (std::size_t k = 1; k + 1 < steps.size(); ++k) {
            const double ratio = (steps[k] + floor) / ((steps[k - 1] + steps[k + 1]) / 2.0 + floor);
            const auto phase = static_cast<int>((k + 1) % static_cast<std::size_t>(block));
            (phase == 0 ? at_borders : elsewhere).push_back(ratio);
            if (by_largest) by_phase[static_cast<std::size_t>(phase)].push_back(ratio);
            if (phase == block / 2) half_way.push_back(ratio);
            if (phase == block / 4 || phase == 3 * block / 4) quarter_way.push_back(ratio);
        }
    }
    if (at_borders.size() < kLeastBorders) return 1.0;
    const double usual = median(elsewhere), border = median(at_borders), half = median(half_way);
    if (half > kHalfStandsOut * median(quarter_way) && half > kHalfAsMuch * border) return 1.0;
    double divisor = usual;
    for (std::size_t phase = 1; by_largest && phase < by_phase.size(); ++phase)
        divisor = std::max(divisor, median(by_phase[phase]));
    return divisor > 0.0 ? border / divisor : 1.0;
}

double largest_ratio(const Stored& stored, int block, bool by_largest) {
    const std::vector<Rect> windows = sample_windows(stored.extent());
    double most = 1.0;
    for (const Component component : {Component::x, Component::y}) {
        const Plane<float>& plane = stored.image->planes[static_cast<std::size_t>(stored.channel(component))];
        most = std::max(most, std::min(axis_ratio(plane, windows, block, true, by_largest),
                                       axis_ratio(plane, windows, block, false, by_largest)));
    }
    return most;
}

using Color = std::array<float, 3>;

constexpr float kCode = 1.0f / 255.0f;
constexpr float kContrast = 8.0f * kCode;  // between the ends of a palette: below it, rounding hides the others
constexpr float kOffPalette = 1.5f * kCode;
constexpr std::size_t kMostColors = 4;    // of a block of BC1 to BC3
constexpr double kBlocksForShare = 64.0;  // fewer blocks give no reliable share

enum class Palette { unclear, fits, differs };

// The distinct colours of a block. One colour more than kMostColors stands for all further ones.
struct BlockColors {
    std::array<Color, kMostColors + 1> color;
    std::size_t count = 0;

    [[nodiscard]] const Color* begin() const { return color.data(); }
    [[nodiscard]] const Color* end() const { return color.data() + count; }
};

BlockColors colors_of(const Image& image, std::size_t channels, int x, int y) {
    BlockColors seen;
    for (int j = 0; j < kBlockEdge; ++j) {
        const float* rows[3] = {};
        for (std::size_t c = 0; c < channels; ++c) rows[c] = image.planes[c].row(y + j) + x;
        for (int i = 0; i < kBlockEdge; ++i) {
            Color color{};
            for (std::size_t c = 0; c < channels; ++c) color[c] = rows[c][i];
            if (std::find(seen.begin(), seen.end(), color) != seen.end()) continue;
            seen.color[seen.count++] = color;
            if (seen.count > kMostColors) return seen;
        }
    }
    return seen;
}

// Whether `color` lies one third, half or two thirds of the way from one end to the other.
bool is_between(const Color& color, const Color& first, const Color& last) {
    for (const float t : {1.0f / 3.0f, 0.5f, 2.0f / 3.0f}) {
        bool near = true;
        for (std::size_t c = 0; c < color.size(); ++c)
            near = near && std::abs(first[c] + t * (last[c] - first[c]) - color[c]) <= kOffPalette;
        if (near) return true;
    }
    return false;
}

float contrast(const Color& a, const Color& b) {
    float most = 0.0f;
    for (std::size_t c = 0; c < a.size(); ++c) most = std::max(most, std::abs(a[c] - b[c]));
    return most;
}

// Whether the texels of a block form a palette: two colours and one or two evenly spaced between them. One or two
// colours alone fit any palette.
Palette palette_of(const Image& image, std::size_t channels, int x, int y) {
    const BlockColors found = colors_of(image, channels, x, y);
    if (found.count > kMostColors) return Palette::differs;
    if (found.count < 3) return Palette::unclear;
    const auto& colors = found.color;
    std::size_t first = 0, last = 1;
    for (std::size_t a = 0; a < found.count; ++a) {
        for (std::size_t b = a + 1; b < found.count; ++b) {
            if (contrast(colors[a], colors[b]) > contrast(colors[first], colors[last])) first = a, last = b;
        }
    }
    if (contrast(colors[first], colors[last]) < kContrast) return Palette::unclear;
    for (std::size_t k = 0; k < found.count; ++k) {
        if (k != first && k != last && !is_between(colors[k], colors[first], colors[last])) return Palette::differs;
    }
    return Palette::fits;
}

// The share among the blocks whose corners lie at `offset` plus multiples of `pitch`; 0 if fewer than `least` blocks
// count.
double share_at(const Stored& stored, int offset, int pitch, double least) {
    const std::size_t channels = std::min<std::size_t>(stored.image->planes.size(), 3);
    double fits = 0.0, all = 0.0;
    for (const Rect& window : sample_windows(stored.extent())) {
        for (int y = offset; y + kBlockEdge <= window.height; y += pitch) {
            for (int x = offset; x + kBlockEdge <= window.width; x += pitch) {
                const Palette palette = palette_of(*stored.image, channels, window.x + x, window.y + y);
                if (palette == Palette::unclear) continue;
                all += 1.0;
                if (palette == Palette::fits) fits += 1.0;
            }
        }
    }
    return all >= least ? fits / all : 0.0;
}

// Whether all rows of the map are equal, or all of its columns. A wave along one axis has four colours at even
// distances, as a palette has.
bool is_along_one_axis(const Image& image) {
    bool rows = true, columns = true;
    for (const Plane<float>& plane : image.planes) {
        const auto [width, height] = plane.extent();
        for (int j = 0; j < height && (rows || columns); ++j) {
            const float* const row = plane.row(j);
            rows = rows && std::equal(row, row + width, plane.row(0));
            columns = columns && std::all_of(row, row + width, [row](float value) { return value == row[0]; });
        }
    }
    return rows || columns;
}

}  // namespace

double grid_excess(const Stored& stored, int block) {
    double most = 0.0;
    for (const Component component : {Component::x, Component::y}) {
        const Plane<float>& plane = stored.image->planes[static_cast<std::size_t>(stored.channel(component))];
        double least = 2.0;
        for (const bool columns : {true, false}) {
            double at_borders = 0.0, inside = 0.0, borders = 0.0, others = 0.0;
            for (const Rect& window : sample_windows(stored.extent())) {
                const std::vector<double> steps = mean_steps(plane, window, columns);
                const double lines = columns ? window.height : window.width;
                for (std::size_t k = 0; k < steps.size(); ++k) {
                    const bool border = (k + 1) % static_cast<std::size_t>(block) == 0;
                    (border ? at_borders : inside) += steps[k];
                    (border ? borders : others) += lines;
                }
            }
            if (borders > 0.0 && others > 0.0) least = std::min(least, at_borders / borders - inside / others);
        }
        if (least < 2.0) most = std::max(most, least);
    }
    return most;
}

double grid_ratio(const Stored& stored, int block) { return largest_ratio(stored, block, false); }

double grid_lead(const Stored& stored, int block) { return largest_ratio(stored, block, true); }

double palette_share(const Stored& stored) {
    if (is_along_one_axis(*stored.image)) return 0.0;
    const double share = share_at(stored, 0, kBlockEdge, kBlocksForShare);
    if (share == 0.0) return 0.0;
    // Blocks that straddle those of a codec, and, within a JPEG's blocks of 8x8, blocks across the middle.
    const double across = std::max(share_at(stored, 2, kBlockEdge, 1.0), share_at(stored, 2, 2 * kBlockEdge, 1.0));
    return share - across;
}

}  // namespace tex::inline v1
