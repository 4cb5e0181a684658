// SPDX-License-Identifier: Apache-2.0

#include "checks/few_values.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include <tex/types.h>

namespace tex::inline v1 {
namespace {

constexpr std::int64_t kLeastManyTexels = 64 * 64;  // pixel art has few colours
constexpr std::size_t kSmallestPalette = 24, kLargestPalette = 256;
// In the maps of wild4 that have so few colours of their own, each lies a code or two from another one, or flat facets
// have few neighbours that differ.
constexpr double kLoneCodes = 2.5, kLeastLone = 0.1;  // share of the texels
constexpr double kLeastSteps = 0.1;                   // of all pairs of neighbours: those that differ,
constexpr double kLeastNearSteps = 0.02;              // by no more than colours lie apart there
constexpr double kNearStep = 2.5;                     // times the distance to the nearest colour
// Colours beside each one, to its right, in the mean: patterns that repeat exactly have one or two.
constexpr std::size_t kFewestNeighbors = 3;

using StoredColor = std::array<float, 3>;  // x, y and z; 0 for a z that is not stored

struct PaletteColor {
    std::int64_t texels = 0;
    std::size_t index = 0;
    double codes = 1e9, degrees = 180.0;  // to the nearest other colour
};
using PaletteColors = std::map<StoredColor, PaletteColor>;

class ColorRows {
public:
    explicit ColorRows(const Stored& stored)
        : x_(plane_of(stored, Component::x)), y_(plane_of(stored, Component::y)), z_(plane_of(stored, Component::z)) {}
    [[nodiscard]] StoredColor at(int i, int j) const {
        return {x_->at(i, j), y_->at(i, j), z_ != nullptr ? z_->at(i, j) : 0.0f};
    }

private:
    static const Plane<float>* plane_of(const Stored& stored, Component component) {
        const int channel = stored.channel(component);
        return channel < 0 ? nullptr : &stored.image->planes[static_cast<std::size_t>(channel)];
    }
    const Plane<float>*x_, *y_, *z_;
};

// The larger of the differences of x and of y, in codes of 8 bits.
double codes_between(const StoredColor& a, const StoredColor& b) {
    return 255.0 * static_cast<double>(std::max(std::abs(a[0] - b[0]), std::abs(a[1] - b[1])));
}

// Between the vectors of x and y; z follows.
double degrees_between(const StoredColor& a, const StoredColor& b) {
    constexpr double kDegrees = 57.29577951308232;
    const auto vector_of = [](const StoredColor& color) {
        const double x = 2.0 * static_cast<double>(color[0]) - 1.0, y = 2.0 * static_cast<double>(color[1]) - 1.0;
        const double square = x * x + y * y, z = std::sqrt(std::max(0.0, 1.0 - square));
        const double length = std::sqrt(square + z * z);
        return std::array{x / length, y / length, z / length};
    };
    const auto u = vector_of(a), v = vector_of(b);
    return kDegrees * std::acos(std::clamp(u[0] * v[0] + u[1] * v[1] + u[2] * v[2], -1.0, 1.0));
}

// The colours of every `step`-th row, if there are so few; nothing if there are more, or few texels.
PaletteColors few_colors(const Stored& stored, int step) {
    if (stored.extent().texels() < kLeastManyTexels) return {};
    const ColorRows rows(stored);
    PaletteColors colors;
    auto last = colors.end();  // neighbours often have the same colour
    for (int j = 0; j < stored.extent().height; j += step) {
        for (int i = 0; i < stored.extent().width; ++i) {
            const StoredColor color = rows.at(i, j);
            if (last == colors.end() || last->first != color) last = colors.try_emplace(color).first;
            ++last->second.texels;
            if (colors.size() > kLargestPalette) return {};
        }
    }
    return colors;
}

// Numbers the colours, and finds how far each is from the nearest other one.
void find_nearest(PaletteColors& colors) {
    std::size_t index = 0;
    for (auto& [color, one] : colors) {
        one.index = index++;
        for (const auto& [other, unused] : colors) {
            if (other == color) continue;
            one.codes = std::min(one.codes, codes_between(color, other));
            one.degrees = std::min(one.degrees, degrees_between(color, other));
        }
    }
}

// Neighbours in rows.
struct ColorSteps {
    std::int64_t pairs = 0;
    std::int64_t all = 0;   // those that differ
    std::int64_t near = 0;  // those of them whose colours lie apart from all others, and next to each other
    std::size_t kinds = 0;  // of pairs of colours that differ
};

ColorSteps count_steps(const Stored& stored, const PaletteColors& colors, int step) {
    const ColorRows rows(stored);
    ColorSteps steps;
    std::vector<bool> is_met(colors.size() * colors.size());
    for (int j = 0; j < stored.extent().height; j += step) {
        for (int i = 1; i < stored.extent().width; ++i) {
            const StoredColor a = rows.at(i - 1, j), b = rows.at(i, j);
            ++steps.pairs;
            if (a == b) continue;
            ++steps.all;
            const PaletteColor &left = colors.at(a), &right = colors.at(b);
            is_met[left.index * colors.size() + right.index] = true;
            const bool is_near = std::min(left.codes, right.codes) > kLoneCodes &&
                                 codes_between(a, b) <= kNearStep * std::max(left.codes, right.codes);
            steps.near += is_near ? 1 : 0;
        }
    }
    steps.kinds = static_cast<std::size_t>(std::count(is_met.begin(), is_met.end(), true));
    return steps;
}

}  // namespace

Palette find_palette(const Stored& stored) {
    constexpr int kMostRows = 1024;
    const int step = 1 + (stored.extent().height - 1) / kMostRows;
    PaletteColors colors = few_colors(stored, step);
    if (colors.size() < kSmallestPalette) return {};
    find_nearest(colors);
    double all = 0.0, lone = 0.0, degrees = 0.0;
    for (const auto& [color, one] : colors) {
        const auto texels = static_cast<double>(one.texels);
        all += texels;
        if (one.codes <= kLoneCodes) continue;
        lone += texels;
        degrees += texels * one.degrees;
    }
    if (lone < kLeastLone * all) return {};
    const ColorSteps steps = count_steps(stored, colors, step);
    const auto of_pairs = [&](std::int64_t count) {
        return static_cast<double>(count) / static_cast<double>(steps.pairs);
    };
    if (steps.kinds < kFewestNeighbors * colors.size()) return {};
    if (of_pairs(steps.all) < kLeastSteps || of_pairs(steps.near) < kLeastNearSteps) return {};
    const std::size_t count = step > 1 ? few_colors(stored, 1).size() : colors.size();  // 0: other rows have more
    return {static_cast<int>(count), lone / all, degrees / lone};
}

int few_levels(const Stored& stored) {
    constexpr int kLeastDistance = 4, kFewestLevels = 6;
    int most = 0;
    for (const Component component : {Component::x, Component::y}) {
        const Plane<float>& plane = stored.image->planes[static_cast<std::size_t>(stored.channel(component))];
        std::array<bool, 256> is_used{};
        // How many values there are, or 0 if two of them lie near to each other.
        const auto count_levels = [&is_used] {
            int levels = 0;
            for (int code = 0, last = -kLeastDistance; code < 256; ++code) {
                if (!is_used[static_cast<std::size_t>(code)]) continue;
                if (code - last < kLeastDistance) return 0;
                last = code;
                ++levels;
            }
            return levels;
        };
        int levels = 0;
        for (int j = 0; j < stored.extent().height; ++j) {
            for (int i = 0; i < stored.extent().width; ++i) {
                const float code = 255.0f * std::clamp(plane.at(i, j), 0.0f, 1.0f);
                is_used[static_cast<std::size_t>(code + 0.5f)] = true;
            }
            levels = count_levels();
            if (levels == 0) return 0;
        }
        if (levels < kFewestLevels) return 0;
        most = std::max(most, levels);
    }
    return most;
}

}  // namespace tex::inline v1
