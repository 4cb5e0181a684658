// SPDX-License-Identifier: Apache-2.0

#include "checks/scaled.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace tex::inline v1 {
namespace {

constexpr int kScaledLines = 64;
constexpr int kScaledMostFactor = 16;
constexpr int kScaledLeastCells = 8;         // of a line: fewer fit by chance
constexpr float kClearBend = 2.5f / 255.0f;  // a second difference that rounding to 8 bits does not make
constexpr double kLeastBends = 64.0;         // fewer show nothing
constexpr double kMostElsewhere = 0.01;      // share of the clear ones that lie where there ought to be none

// Lines of stored values, all of one length.
using ValueLines = std::vector<std::vector<float>>;

ValueLines lines_of(const Stored& stored, bool rows) {
    ValueLines lines;
    const Extent extent = stored.extent();
    const int count = rows ? extent.height : extent.width, length = rows ? extent.width : extent.height;
    const int step = std::max(1, count / kScaledLines);
    for (const Component component : {Component::x, Component::y}) {
        const Plane<float>& plane = stored.image->planes[static_cast<std::size_t>(stored.channel(component))];
        for (int k = step / 2; k < count; k += step) {
            std::vector<float>& line = lines.emplace_back(static_cast<std::size_t>(length));
            for (int i = 0; i < length; ++i) line[static_cast<std::size_t>(i)] = rows ? plane.at(i, k) : plane.at(k, i);
        }
    }
    return lines;
}

// By phase, position modulo `factor`: the largest step to the next value, and how many second differences are clear.
struct Phases {
    std::array<float, kScaledMostFactor> step{};
    std::array<double, kScaledMostFactor> bends{};
};

Phases phases_of(const ValueLines& lines, int factor) {
    Phases phases;
    for (const std::vector<float>& line : lines) {
        std::size_t p = 0;
        for (std::size_t i = 1; i + 1 < line.size(); ++i) {
            p = p + 1 == static_cast<std::size_t>(factor) ? 0 : p + 1;
            const float before = line[i - 1], value = line[i], after = line[i + 1];
            phases.step[p] = std::max(phases.step[p], std::abs(after - value));
            phases.bends[p] += std::abs(before - 2.0f * value + after) > kClearBend ? 1.0 : 0.0;
        }
    }
    return phases;
}

bool repeats(const Phases& phases, int factor) {
    const auto last = static_cast<std::size_t>(factor - 1);
    return phases.step[last] > 0.0f &&
           std::all_of(phases.step.begin(), phases.step.begin() + factor - 1, [](float s) { return s == 0.0f; });
}

bool are_elsewhere_rare(double expected, double elsewhere) {
    return expected >= kLeastBends && elsewhere <= kMostElsewhere * expected;
}

// Kinks lie in the middle between corners alone: for even factors between two values, for odd ones at one.
bool bends_half_way(const Phases& phases, int factor) {
    double middle = 0.0, elsewhere = 0.0;
    for (int p = 0; p < factor; ++p) {
        const bool is_middle = p == factor / 2 || p == (factor - 1) / 2;
        (is_middle ? middle : elsewhere) += phases.bends[static_cast<std::size_t>(p)];
    }
    return are_elsewhere_rare(middle, elsewhere);
}

// Twice the size, linear: the step inside of a pair is the mean of the steps beside it.
bool interpolates_pairs(const ValueLines& lines) {
    double inside = 0.0, between = 0.0;
    for (const std::vector<float>& line : lines) {
        for (std::size_t i = 2; i + 4 < line.size(); i += 2) {
            const auto step = [&line](std::size_t k) { return line[k + 1] - line[k]; };
            inside += std::abs(step(i) - 0.5f * (step(i - 1) + step(i + 1))) > kClearBend ? 1.0 : 0.0;
            between += std::abs(step(i + 1) - 0.5f * (step(i) + step(i + 2))) > kClearBend ? 1.0 : 0.0;
        }
    }
    return are_elsewhere_rare(between, inside);
}

}  // namespace

Enlargement find_enlargement(const Stored& stored) {
    const ValueLines rows = lines_of(stored, true);
    ValueLines columns;  // which take longer to collect: only if the rows of some factor agree
    const auto of_columns = [&]() -> const ValueLines& {
        if (columns.empty()) columns = lines_of(stored, false);
        return columns;
    };
    const Extent extent = stored.extent();
    for (int factor = kScaledMostFactor; factor >= 2; --factor) {
        if (std::min(extent.width, extent.height) < kScaledLeastCells * factor) continue;
        if (extent.width % factor != 0 || extent.height % factor != 0) continue;
        const Phases across = phases_of(rows, factor);
        if (repeats(across, factor) && repeats(phases_of(of_columns(), factor), factor)) return {factor, false};
        if (factor > 2 && bends_half_way(across, factor) && bends_half_way(phases_of(of_columns(), factor), factor))
            return {factor, true};
        if (factor == 2 && interpolates_pairs(rows) && interpolates_pairs(of_columns())) return {2, true};
    }
    return {};
}

}  // namespace tex::inline v1
