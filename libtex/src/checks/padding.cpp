// SPDX-License-Identifier: Apache-2.0

#include "checks/padding.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "checks/thresholds.h"
#include "surface/nearest.h"
#include "threads/no_throw.h"

namespace tex::inline v1 {
namespace {

// In the plane of charts: background that differs from the chart beside it.
constexpr std::int32_t kHarmful = -2;

using Direction = std::array<float, 2>;  // x and y

class Components {
public:
    explicit Components(const Stored& stored)
        : stored_(stored), x_(stored.channel(Component::x)), y_(stored.channel(Component::y)) {}
    [[nodiscard]] Direction at(int i, int j) const {
        return {stored_.component(x_, i, j), stored_.component(y_, i, j)};
    }

private:
    const Stored& stored_;
    int x_, y_;
};

double distance(const Direction& a, const Direction& b) {
    const double x = static_cast<double>(a[0]) - static_cast<double>(b[0]);
    const double y = static_cast<double>(a[1]) - static_cast<double>(b[1]);
    return std::sqrt(x * x + y * y);
}

// The most frequent value outside of the charts, if it is frequent.
std::optional<Direction> background_of(const Components& map, const Plane<std::int32_t>& charts) {
    std::vector<std::int64_t> counts(std::size_t{256} * 256);
    std::int64_t outside = 0;
    const auto code = [](float c) {
        return static_cast<std::size_t>(std::clamp(c * 127.5f + 127.5f, 0.0f, 255.0f) + 0.5f);
    };
    for (int j = 0; j < charts.extent().height; ++j) {
        for (int i = 0; i < charts.extent().width; ++i) {
            if (charts.at(i, j) != kNoChart) continue;
            const Direction v = map.at(i, j);
            if (!std::isfinite(v[0] + v[1])) continue;
            ++outside;
            ++counts[code(v[0]) * 256 + code(v[1])];
        }
    }
    const auto most = std::max_element(counts.begin(), counts.end());
    if (outside == 0 || static_cast<double>(*most) < thresholds::kBackground * static_cast<double>(outside)) return {};
    const auto peak = static_cast<std::size_t>(most - counts.begin());
    const auto component = [](std::size_t c) { return static_cast<float>(c) / 127.5f - 1.0f; };
    return Direction{component(peak / 256), component(peak % 256)};
}

// Replaces kNoChart by kHarmful where the map shows a background that differs from the nearest chart.
Result<void> mark_background(const Stored& stored, Plane<std::int32_t>& charts, const Execution& execution) {
    const Components map(stored);
    const std::optional<Direction> background = background_of(map, charts);
    if (!background) return {};
    Plane<float> covered(charts.extent());
    bool any = false;
    for (int j = 0; j < charts.extent().height; ++j) {
        for (int i = 0; i < charts.extent().width; ++i) {
            const bool inside = charts.at(i, j) >= 0;
            covered.at(i, j) = inside ? 0.0f : std::numeric_limits<float>::quiet_NaN();
            any |= inside;
        }
    }
    if (!any) return {};
    constexpr double kSame = 2.5 / 127.5;  // codes of 8 bits, as block codecs leave them
    return visit_holes(covered.view(), Wrap::repeat, Wrap::repeat, execution, {}, [&](const NearestTexel& hole) {
        if (distance(map.at(hole.i, hole.j), *background) > kSame) return;
        if (distance(map.at(hole.column, hole.row), *background) <= thresholds::kBleed) return;
        charts.at(hole.i, hole.j) = kHarmful;
    });
}

// What a texel of a smaller level covers.
struct Cell {
    std::int32_t chart = kNoChart;  // one of them
    bool several = false;           // charts
    bool outside = false;           // texels outside of all charts
    bool harmful = false;           // background that differs from the chart beside it

    void add(const Cell& other) {
        several |= other.several || (chart >= 0 && other.chart >= 0 && chart != other.chart);
        outside |= other.outside;
        harmful |= other.harmful;
        chart = std::max(chart, other.chart);
    }
};

Cell cell_of(std::int32_t chart) { return {std::max(chart, kNoChart), false, chart < 0, chart == kHarmful}; }

// The next level: each texel covers two by two. A last row or column without a partner is left out.
template <class Get>
std::vector<Cell> halved(Extent to, const Get& get) {
    std::vector<Cell> cells(static_cast<std::size_t>(to.texels()));
    for (int j = 0; j < to.height; ++j) {
        for (int i = 0; i < to.width; ++i) {
            Cell& cell =
                cells[static_cast<std::size_t>(j) * static_cast<std::size_t>(to.width) + static_cast<std::size_t>(i)];
            for (const int y : {2 * j, 2 * j + 1}) {
                for (const int x : {2 * i, 2 * i + 1}) cell.add(get(x, y));
            }
        }
    }
    return cells;
}

PaddingMeasure measure_of(const std::vector<Cell>& cells, int level) {
    std::int64_t borders = 0, background = 0, charts = 0;
    for (const Cell& cell : cells) {
        if (cell.chart < 0 || !(cell.several || cell.outside)) continue;
        ++borders;
        charts += cell.several ? 1 : 0;
        background += !cell.several && cell.harmful ? 1 : 0;
    }
    if (borders == 0) return {};
    return {level, static_cast<double>(background + charts) / static_cast<double>(borders), background > charts};
}

}  // namespace

Result<PaddingMeasure> measure_padding(const Stored& stored, Plane<std::int32_t>& charts, const Execution& execution) {
    return no_throw([&]() -> Result<PaddingMeasure> {
        if (const auto marked = mark_background(stored, charts, execution); !marked) return marked.error();
        Extent extent = charts.extent();
        std::vector<Cell> cells;
        for (int level = 1; std::max(extent.width, extent.height) / 2 >= thresholds::kPaddedSide; ++level) {
            const Extent from = extent;
            extent = {std::max(1, from.width / 2), std::max(1, from.height / 2)};
            const auto stored_cell = [&](int x, int y) {
                return cell_of(charts.at(std::min(x, from.width - 1), std::min(y, from.height - 1)));
            };
            const auto cell = [&](int x, int y) {
                return cells[static_cast<std::size_t>(std::min(y, from.height - 1)) *
                                 static_cast<std::size_t>(from.width) +
                             static_cast<std::size_t>(std::min(x, from.width - 1))];
            };
            cells = level == 1 ? halved(extent, stored_cell) : halved(extent, cell);
            const PaddingMeasure measure = measure_of(cells, level);
            if (measure.share > thresholds::kBleedShare) return measure;
        }
        return PaddingMeasure{};
    });
}

}  // namespace tex::inline v1
