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
constexpr int kScaledLeastCells = 8;  // of a line: fewer fit by chance
constexpr double kScaledCode = 1.0 / 255.0;
constexpr double kScaledRounding = 0.8 * kScaledCode;  // mean second difference of values that lie on a line before rounding
constexpr double kScaledStandsOut = 4.0;

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

// Mean magnitudes by phase, position modulo `factor`: of steps to the next value, and of second differences.
struct PhaseMeans {
    std::array<double, kScaledMostFactor> step{}, bend{};
    std::array<double, kScaledMostFactor> count{};
};

PhaseMeans phases_of(const ValueLines& lines, int factor) {
    PhaseMeans phases;
    for (const std::vector<float>& line : lines) {
        for (std::size_t i = 1; i + 1 < line.size(); ++i) {
            const auto p = i % static_cast<std::size_t>(factor);
            const double before = line[i - 1], value = line[i], after = line[i + 1];
            const double bend = std::abs(before - 2.0 * value + after);
            if (!(bend < 1e6)) continue;
            phases.step[p] += std::abs(after - value);
            phases.bend[p] += bend;
            phases.count[p] += 1.0;
        }
    }
    for (std::size_t p = 0; p < static_cast<std::size_t>(factor); ++p) {
        phases.step[p] /= std::max(1.0, phases.count[p]);
        phases.bend[p] /= std::max(1.0, phases.count[p]);
    }
    return phases;
}

bool repeats(const PhaseMeans& phases, int factor) {
    const auto last = static_cast<std::size_t>(factor - 1);
    return phases.step[last] > 0.0 &&
           std::all_of(phases.step.begin(), phases.step.begin() + factor - 1, [](double s) { return s == 0.0; });
}

// Kinks lie in the middle between corners alone: for even factors between two values, for odd ones at one.
bool bends_half_way(const PhaseMeans& phases, int factor) {
    double middle = 0.0, elsewhere = 0.0;
    for (int p = 0; p < factor; ++p) {
        const bool is_middle = p == factor / 2 || p == (factor - 1) / 2;
        double& most = is_middle ? middle : elsewhere;
        most = std::max(most, phases.bend[static_cast<std::size_t>(p)]);
    }
    return elsewhere < kScaledRounding && middle > kScaledStandsOut * std::max(elsewhere, 0.5 * kScaledCode);
}

// Twice the size, linear: the step inside of a pair is the mean of the steps beside it.
bool interpolates_pairs(const ValueLines& lines) {
    double inside = 0.0, between = 0.0, count = 0.0;
    for (const std::vector<float>& line : lines) {
        for (std::size_t i = 2; i + 4 < line.size(); i += 2) {
            const auto step = [&line](std::size_t k) { return static_cast<double>(line[k + 1]) - line[k]; };
            const double off = std::abs(step(i) - 0.5 * (step(i - 1) + step(i + 1)));
            if (!(off < 1e6)) continue;
            inside += off;
            between += std::abs(step(i + 1) - 0.5 * (step(i) + step(i + 2)));
            count += 1.0;
        }
    }
    inside /= std::max(1.0, count);
    between /= std::max(1.0, count);
    return inside < kScaledRounding && between > kScaledStandsOut * std::max(inside, 0.5 * kScaledCode);
}

}  // namespace

Enlargement find_enlargement(const Stored& stored) {
    const ValueLines rows = lines_of(stored, true), columns = lines_of(stored, false);
    const Extent extent = stored.extent();
    for (int factor = kScaledMostFactor; factor >= 2; --factor) {
        if (std::min(extent.width, extent.height) < kScaledLeastCells * factor) continue;
        if (extent.width % factor != 0 || extent.height % factor != 0) continue;
        const PhaseMeans across = phases_of(rows, factor), down = phases_of(columns, factor);
        if (repeats(across, factor) && repeats(down, factor)) return {factor, false};
        if (factor > 2 && bends_half_way(across, factor) && bends_half_way(down, factor)) return {factor, true};
        if (factor == 2 && interpolates_pairs(rows) && interpolates_pairs(columns)) return {2, true};
    }
    return {};
}

}  // namespace tex::inline v1
