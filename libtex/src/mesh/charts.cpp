// SPDX-License-Identifier: Apache-2.0

#include "mesh/charts.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <tuple>

#include "mesh/disjoint_sets.h"

namespace tex::inline v1 {
std::vector<std::int32_t> charts_of(const MeshPart& part, int uv_set) {
    const std::vector<Float2>& uvs = part.uvs[static_cast<std::size_t>(uv_set)];
    DisjointSets sets(uvs.size());
    std::vector<std::uint32_t> order(uvs.size());
    std::iota(order.begin(), order.end(), 0U);
    const auto place = [&](std::uint32_t v) { return std::tuple(uvs[v].x, uvs[v].y); };
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return place(a) < place(b); });
    for (std::size_t k = 1; k < order.size(); ++k) {
        if (place(order[k - 1]) == place(order[k])) sets.join(order[k - 1], order[k]);
    }
    for (std::size_t t = 0; t < part.triangles(); ++t) {
        sets.join(part.indices[3 * t], part.indices[3 * t + 1]);
        sets.join(part.indices[3 * t], part.indices[3 * t + 2]);
    }
    std::vector<std::int32_t> number(uvs.size(), -1), charts(part.triangles());
    std::int32_t next = 0;
    for (std::size_t t = 0; t < charts.size(); ++t) {
        std::int32_t& chart = number[sets.root(part.indices[3 * t])];
        if (chart < 0) chart = next++;
        charts[t] = chart;
    }
    return charts;
}

}  // namespace tex::inline v1
