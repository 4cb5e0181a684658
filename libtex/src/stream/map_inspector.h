// SPDX-License-Identifier: Apache-2.0
// map_inspector.h: looks at normals that pass by for signs that they are not what they were taken for.

#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <tex/file.h>
#include <tex/types.h>

#include "checks/stored.h"
#include "checks/y_verdict.h"
#include "kernels/normal_row.h"

namespace tex::inline v1 {

// What an inspector looks at, of large maps: a glance, 2^18 texels, for background and vectors that face away; or what
// check() measures, 2^20, where y is in doubt: a weak direction that check() sees must not be one that this overlooks.
enum class Look { glance, as_check };

// Looks at parts of a map, and keeps their slopes if it measures y.
class MapInspector {
public:
    explicit MapInspector(Extent extent, bool measures_y = true, Look look = Look::glance);

    // Whether add_row() looks at row j.
    [[nodiscard]] bool wants(int j) const;
    // Takes row j of the map, unpacked or with lengths as stored, with y up according to the assumption. Rows come in
    // any order, each once; those that it does not want may be left out.
    void add_row(int j, const VectorRow& row);

    // Where y points. Call it once, after the last row. Precondition: it measures y.
    [[nodiscard]] YVerdict y();
    // Sets what SourceInfo says about the texels. Call it once, after the last row.
    void report(SourceInfo& info);

private:
    // The slopes of a part that lies in one window, or reaches beyond it.
    [[nodiscard]] Slopes slopes_at(const Rect& part) const;

    const Extent extent_;
    const bool measures_y_;
    std::vector<Rect> windows_;
    std::vector<Slopes> slopes_;
    std::int64_t texels_ = 0, background_ = 0, behind_ = 0;
};

// Where y of a whole map points, as check() sees it; if that does not show, SourceOptions::y_otherwise. Errors, without
// a file: it does not show, or parts differ.
[[nodiscard]] Result<YAxis> measured_y(const NormalMap& map, const SourceOptions& options = {});
[[nodiscard]] Result<YAxis> measured_y(const YVerdict& verdict, const SourceOptions& options);

// Inspects a whole map as the options say. Precondition: `info` knows whether y is assumed.
void inspect(const NormalMap& map, const SourceOptions& options, SourceInfo& info);

// Whether there is anything to inspect, and whether y is.
[[nodiscard]] std::optional<MapInspector> inspector_for(const SourceOptions& options, const SourceInfo& info,
                                                        Extent extent);

}  // namespace tex::inline v1
