// SPDX-License-Identifier: Apache-2.0

#include "checks/few_values.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <set>

#include <tex/types.h>

namespace tex::inline v1 {
namespace {

constexpr std::int64_t kLeastManyTexels = 64 * 64;  // pixel art has few colours

}  // namespace

int few_colors(const Stored& stored) {
    constexpr std::size_t kMostColors = 256;
    const auto& planes = stored.image->planes;
    if (planes.size() < 3 || stored.extent().texels() < kLeastManyTexels) return 0;
    std::set<std::array<float, 3>> colors;
    std::array<float, 3> last{-1.0f, -1.0f, -1.0f};  // neighbours often have the same colour
    for (int j = 0; j < stored.extent().height; ++j) {
        for (int i = 0; i < stored.extent().width; ++i) {
            const std::array<float, 3> color = {planes[0].at(i, j), planes[1].at(i, j), planes[2].at(i, j)};
            if (color == last) continue;
            last = color;
            colors.insert(color);
            if (colors.size() > kMostColors) return 0;
        }
    }
    return static_cast<int>(colors.size());
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
