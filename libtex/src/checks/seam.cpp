// SPDX-License-Identifier: Apache-2.0

#include "checks/seam.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace tex::inline v1 {
namespace {

constexpr int kLeastLines = 8;
constexpr double kLeastStep = 1.0 / 255.0;  // half a code

// The lines along one axis whose neighbours are compared.
struct SeamLines {
    const Stored& stored;
    int channel;
    bool columns;
    [[nodiscard]] int count() const { return columns ? stored.extent().width : stored.extent().height; }
    [[nodiscard]] int length() const { return columns ? stored.extent().height : stored.extent().width; }

    // Mean steps from lines `first` to `last - 1` to the next ones, that of the last line to the first. The texels of a
    // line are added in their order, whatever the range.
    void add(int first, int last, double* steps) const {
        const Extent extent = stored.extent();
        const double texels = length();
        std::fill(steps, steps + (last - first), 0.0);
        for (int j = columns ? 0 : first; j < (columns ? extent.height : last); ++j) {
            const int nj = columns || j + 1 < extent.height ? j + 1 : 0;
            for (int i = columns ? first : 0; i < (columns ? last : extent.width); ++i) {
                const int ni = i + 1 < extent.width ? i + 1 : 0;
                const float next = columns ? stored.component(channel, ni, j) : stored.component(channel, i, nj);
                const double step = std::abs(static_cast<double>(next) - stored.component(channel, i, j));
                if (step <= 2.0) steps[(columns ? i : j) - first] += step / texels;  // false for NaN
            }
        }
    }
};

// Whether the border cannot stand out with a ratio of `least`: one step inside, or rounding, is too near to it.
bool is_refuted(const SeamLines& lines, double least) {
    constexpr int kAtOnce = 16;  // columns in a line of the processor's cache
    double border = 0.0;
    const int last = lines.count() - 1;
    lines.add(last, last + 1, &border);
    if (border < least * kLeastStep) return true;
    std::array<double, kAtOnce> steps{};
    for (int first = 0; first < last; first += kAtOnce) {
        const int end = std::min(last, first + kAtOnce);
        lines.add(first, end, steps.data());
        if (border <= kOverJoints * *std::max_element(steps.begin(), steps.begin() + (end - first))) return true;
    }
    return false;
}

SeamSteps steps_of(const SeamLines& lines) {
    SeamSteps found;
    found.of_columns = lines.columns;
    if (lines.count() < kLeastLines) return found;
    std::vector<double> steps(static_cast<std::size_t>(lines.count()));
    lines.add(0, lines.count(), steps.data());
    found.border = steps.back();
    steps.pop_back();
    found.largest = *std::max_element(steps.begin(), steps.end());
    const auto rank = steps.begin() + static_cast<std::ptrdiff_t>((steps.size() - 1) * 98 / 100);
    std::nth_element(steps.begin(), rank, steps.end());
    found.usual = std::max(*rank, kLeastStep);
    return found;
}

// Calls measure(lines, steps) for x and y along both axes.
template <class Measure>
Seam each_axis(const Stored& stored, Measure&& measure) {
    Seam seam;
    std::size_t k = 0;
    for (const bool columns : {true, false}) {
        for (const Component component : {Component::x, Component::y})
            seam.steps[k++] = measure(SeamLines{stored, stored.channel(component), columns});
    }
    return seam;
}

}  // namespace

double Seam::worst() const {
    double most = 0.0;
    for (const SeamSteps& each : steps) most = std::max(most, each.ratio());
    return most;
}

const SeamSteps* Seam::worst_standing_out() const {
    const SeamSteps* worst = nullptr;
    for (const SeamSteps& each : steps) {
        if (each.stands_out() && (worst == nullptr || each.ratio() > worst->ratio())) worst = &each;
    }
    return worst;
}

Seam measure_seam(const Stored& stored) { return each_axis(stored, steps_of); }

Seam find_seam(const Stored& stored, double least) {
    return each_axis(stored, [least](const SeamLines& lines) {
        const bool is_short = lines.count() < kLeastLines;
        return is_short || is_refuted(lines, least) ? SeamSteps() : steps_of(lines);
    });
}

}  // namespace tex::inline v1
