// SPDX-License-Identifier: Apache-2.0

#include "repairs/whole_heights.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <deque>
#include <utility>

namespace tex::inline v1 {
namespace {

constexpr std::size_t kLeastPart = 64;  // texels that belong together
constexpr std::size_t kMostParts = 64;  // the greatest ones: each is put in place by a look at all texels

// Texels whose heights follow from each other.
struct Part {
    std::vector<std::size_t> texels;
};

class Unwrapping {
public:
    explicit Unwrapping(const WholeSlopes& slopes)
        : slopes_(slopes), part_(slopes.across.size(), -1), height_(slopes.across.size(), 0) {}

    std::vector<std::optional<std::int32_t>> run() {
        find_parts();
        std::vector<std::size_t> order;
        for (std::size_t k = 0; k < parts_.size(); ++k) {
            if (parts_[k].texels.size() >= kLeastPart) order.push_back(k);
        }
        std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
            return parts_[a].texels.size() > parts_[b].texels.size();
        });
        order.resize(std::min(order.size(), kMostParts));
        is_placed_.assign(parts_.size(), false);
        for (const std::size_t k : order) place(k);
        std::vector<std::optional<std::int32_t>> heights(height_.size());
        for (std::size_t t = 0; t < heights.size(); ++t) {
            if (is_placed_[static_cast<std::size_t>(part_[t])]) heights[t] = height_[t];
        }
        return heights;
    }

private:
    [[nodiscard]] int width() const { return slopes_.extent.width; }
    [[nodiscard]] int height() const { return slopes_.extent.height; }

    // How many ways on both sides of a link close, 0 to 2. Beyond the border there is none that does not.
    [[nodiscard]] int trust(int i, int j, bool across) const {
        int sides = 0;
        for (const int side : {-1, 1}) {
            const int a = across ? i : i + side, b = across ? j + side : j;
            const bool is_inside = a > 0 && b > 0 && a < width() - 1 && b < height() - 1;
            sides += !is_inside || slopes_.closes(a, b) ? 1 : 0;
        }
        return sides;
    }

    // Links that close on both sides are followed first.
    void find_parts() {
        std::deque<std::pair<int, int>> next;
        for (int j = 0; j < height(); ++j) {
            for (int i = 0; i < width(); ++i) {
                if (part_[slopes_.at(i, j)] >= 0) continue;
                parts_.emplace_back();
                take(i, j, 0);
                next.emplace_back(i, j);
                while (!next.empty()) {
                    const auto [a, b] = next.front();
                    next.pop_front();
                    follow(a, b, next);
                }
            }
        }
    }

    void take(int i, int j, std::int32_t height) {
        const std::size_t at = slopes_.at(i, j);
        part_[at] = static_cast<std::int32_t>(parts_.size()) - 1;
        height_[at] = height;
        parts_.back().texels.push_back(at);
    }

    void follow(int i, int j, std::deque<std::pair<int, int>>& next) {
        constexpr int kWays[4][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
        for (const auto& [dx, dy] : kWays) {
            const int a = i + 2 * dx, b = j + 2 * dy;
            if (a < 0 || b < 0 || a >= width() || b >= height() || part_[slopes_.at(a, b)] >= 0) continue;
            const std::size_t between = slopes_.at(i + dx, j + dy);
            const std::int16_t rise = dx != 0 ? slopes_.across[between] : slopes_.down[between];
            if (rise == WholeSlopes::kUnknown) continue;
            const int sides = trust(i + dx, j + dy, dx != 0);
            if (sides == 0) continue;
            take(a, b, height_[slopes_.at(i, j)] + (dx + dy) * rise);
            if (sides == 2) {
                next.emplace_front(a, b);
            } else {
                next.emplace_back(a, b);
            }
        }
    }

    // Twice the bend at a texel between two placed neighbours, if there are such.
    void add_bends(std::size_t at, std::vector<std::int32_t>& bends) const {
        const int i = static_cast<int>(at) % width(), j = static_cast<int>(at) / width();
        const auto placed = [&](int a, int b) {
            return a >= 0 && b >= 0 && a < width() && b < height() &&
                   is_placed_[static_cast<std::size_t>(part_[slopes_.at(a, b)])];
        };
        const auto add = [&](int dx, int dy) {
            if (!placed(i - dx, j - dy) || !placed(i + dx, j + dy)) return;
            bends.push_back(height_[slopes_.at(i - dx, j - dy)] + height_[slopes_.at(i + dx, j + dy)] -
                            2 * height_[at]);
        };
        add(1, 0);
        add(0, 1);
        if (!placed(i + 1, j) && !placed(i, j + 1)) add(1, 1);
    }

    void place(std::size_t number) {
        Part& part = parts_[number];
        std::vector<std::int32_t> bends;
        for (const std::size_t at : part.texels) add_bends(at, bends);
        is_placed_[number] = true;
        if (bends.empty()) return;
        // Half of the texels lie between: a cliff beside them says nothing.
        std::sort(bends.begin(), bends.end());
        double sum = 0.0;
        const std::size_t first = bends.size() / 4, end = bends.size() - first;
        for (std::size_t k = first; k < end; ++k) sum += bends[k];
        const auto offset = static_cast<std::int32_t>(std::lround(0.5 * sum / static_cast<double>(end - first)));
        for (const std::size_t at : part.texels) height_[at] += offset;
    }

    const WholeSlopes& slopes_;
    std::vector<std::int32_t> part_, height_;
    std::vector<Part> parts_;
    std::vector<bool> is_placed_;
};

}  // namespace

bool WholeSlopes::closes(int i, int j) const {
    const std::int16_t above = across[at(i, j - 1)], below = across[at(i, j + 1)];
    const std::int16_t left = down[at(i - 1, j)], right = down[at(i + 1, j)];
    if (std::min({above, below, left, right}) == kUnknown) return false;
    return below - above == right - left;
}

double WholeSlopes::closing_share() const {
    double all = 0.0, closed = 0.0;
    for (int j = 1; j + 1 < extent.height; ++j) {
        for (int i = 1; i + 1 < extent.width; ++i) {
            const bool is_level =
                across[at(i, j - 1)] == across[at(i, j + 1)] && down[at(i - 1, j)] == down[at(i + 1, j)];
            if (is_level) continue;
            all += 1.0;
            closed += closes(i, j) ? 1.0 : 0.0;
        }
    }
    return all > 0.0 ? closed / all : 0.0;
}

std::vector<std::optional<std::int32_t>> whole_heights(const WholeSlopes& slopes) { return Unwrapping(slopes).run(); }

}  // namespace tex::inline v1
