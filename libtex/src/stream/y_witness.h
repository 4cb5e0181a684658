// SPDX-License-Identifier: Apache-2.0
// y_witness.h: finds out whether normals that pass by contradict the direction that y was assumed to have.

#pragma once

#include <optional>
#include <vector>

#include <tex/normal_map.h>

#include "checks/stored.h"
#include "kernels/normal_row.h"

namespace tex {

// Looks at parts of a map and keeps their slopes, at most 2^18 texels.
class YWitness {
public:
    explicit YWitness(Extent extent);

    // Takes row j of the unpacked map, with y up according to the assumption. Each row comes once.
    void add_row(int j, const VectorRow& row);

    // Where y points, if the rows show it clearly. Call it once, after the last row.
    [[nodiscard]] std::optional<YAxis> y();
    [[nodiscard]] bool contradicts() { return y() == YAxis::down; }

private:
    const Extent extent_;
    std::vector<Rect> windows_;
    std::vector<Slopes> slopes_;
};

// The same for a whole map.
[[nodiscard]] std::optional<YAxis> shown_y(const NormalMap& map);

}  // namespace tex
