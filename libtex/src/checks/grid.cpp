// SPDX-License-Identifier: Apache-2.0

#include "checks/grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace tex {
namespace {

// Blocks of half the size show as much half-way between the borders as at them, and more than at the quarters.
constexpr double kHalfStandsOut = 1.2;
constexpr double kHalfAsMuch = 0.8;

double median(std::vector<double>& values) {
    if (values.empty()) return 0.0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

// Mean steps of one window along one axis: steps[k] is that between line k and line k + 1.
std::vector<double> mean_steps(const Plane<float>& plane, Rect window, bool columns) {
    const int lines = columns ? window.width : window.height;
    std::vector<double> steps(static_cast<std::size_t>(std::max(0, lines - 1)), 0.0);
    for (int j = 0; j < window.height - (columns ? 0 : 1); ++j) {
        const float* row = plane.row(window.y + j) + window.x;
        const float* other = columns ? row + 1 : plane.row(window.y + j + 1) + window.x;
        for (int i = 0; i < window.width - (columns ? 1 : 0); ++i) {
            const double step = std::abs(static_cast<double>(row[i]) - other[i]);
            // NaN compares false: such texels are another rule's matter.
            if (step < 1e6) steps[static_cast<std::size_t>(columns ? i : j)] += step;
        }
    }
    return steps;
}

double axis_ratio(const Plane<float>& plane, const std::vector<Rect>& windows, int block, bool columns) {
    std::vector<double> at_borders, elsewhere, half_way, quarter_way;
    for (const Rect& window : windows) {
        const std::vector<double> steps = mean_steps(plane, window, columns);
        double sum = 0.0;
        for (const double step : steps) sum += step;
        // What counts as no step at all beside the map's usual ones.
        const double floor = steps.empty() ? 0.0 : 0.02 * sum / static_cast<double>(steps.size());
        if (!(floor > 0.0)) continue;
        for (std::size_t k = 1; k + 1 < steps.size(); ++k) {
            const double ratio = (steps[k] + floor) / ((steps[k - 1] + steps[k + 1]) / 2.0 + floor);
            const auto phase = static_cast<int>((k + 1) % static_cast<std::size_t>(block));
            (phase == 0 ? at_borders : elsewhere).push_back(ratio);
            if (phase == block / 2) half_way.push_back(ratio);
            if (phase == block / 4 || phase == 3 * block / 4) quarter_way.push_back(ratio);
        }
    }
    if (at_borders.size() < 4) return 1.0;
    const double usual = median(elsewhere), border = median(at_borders), half = median(half_way);
    if (half > kHalfStandsOut * median(quarter_way) && half > kHalfAsMuch * border) return 1.0;
    return usual > 0.0 ? border / usual : 1.0;
}

// The number of different colours in a block, up to 5.
int colors_in(const Image& image, std::size_t channels, int x, int y) {
    std::array<std::array<float, 3>, 4> seen{};
    int count = 0;
    for (int j = 0; j < 4; ++j) {
        for (int i = 0; i < 4; ++i) {
            std::array<float, 3> color{};
            for (std::size_t c = 0; c < channels; ++c) color[c] = image.planes[c].at(x + i, y + j);
            const auto end = seen.begin() + count;
            if (std::find(seen.begin(), end, color) != end) continue;
            if (count == 4) return 5;
            seen[static_cast<std::size_t>(count++)] = color;
        }
    }
    return count;
}

double share_at(const Stored& stored, int offset) {
    const std::size_t channels = std::min<std::size_t>(stored.image->planes.size(), 3);
    double few = 0.0, all = 0.0;
    for (const Rect& window : sample_windows(stored.extent())) {
        for (int y = offset; y + 4 <= window.height; y += 4) {
            for (int x = offset; x + 4 <= window.width; x += 4) {
                const int colors = colors_in(*stored.image, channels, window.x + x, window.y + y);
                if (colors == 1) continue;
                all += 1.0;
                if (colors <= 4) few += 1.0;
            }
        }
    }
    return all > 0.0 ? few / all : 0.0;
}

}  // namespace

double grid_ratio(const Stored& stored, int block) {
    const std::vector<Rect> windows = sample_windows(stored.extent());
    double most = 1.0;
    for (const Component component : {Component::x, Component::y}) {
        const Plane<float>& plane = stored.image->planes[static_cast<std::size_t>(stored.channel(component))];
        most =
            std::max(most, std::min(axis_ratio(plane, windows, block, true), axis_ratio(plane, windows, block, false)));
    }
    return most;
}

double palette_share(const Stored& stored) { return share_at(stored, 0) - share_at(stored, 2); }

}  // namespace tex
