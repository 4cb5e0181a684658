// SPDX-License-Identifier: Apache-2.0
// blend_stage.h: turns rows of several maps into rows of the blended map.

#pragma once

#include <optional>
#include <vector>

#include "rows/blend_rows.h"
#include "stream/flow.h"

namespace tex::inline v1 {

// The rows of a map that a result of the same extent needs: row j of the result needs rows j - behind to j + ahead of
// the map, or some of its first `head` rows.
struct RowsInStep {
    int behind = 0;
    int ahead = 0;
    int head = 0;
};

// Returns nothing if a map of this extent cannot keep in step with the result. That is the case if the map has another
// extent, is rotated, repeats, is moved up or down, or shrinks.
std::optional<RowsInStep> rows_in_step(Extent source, Extent result, const UvMap& map, Wrap wrap_x, Wrap wrap_y);

// A map that keeps in step.
struct MapInStep {
    const Stage* rows;
    RowsInStep step;
};

// Makes the same normals as blend().
class BlendStage final : public Stage {
public:
    // `maps` read the rows of those in step, and must outlive this object. `kept`: other data of the base that go
    // along; `base` has their rows, or is null if they are sampled as the normals are.
    BlendStage(const PlacedMaps& maps, std::vector<MapInStep> in_step, ExtraSet kept, const Stage* base)
        : Stage(maps.extent, kept), maps_(maps), in_step_(std::move(in_step)), base_(base) {}

    [[nodiscard]] std::vector<Need> needs(int first, int end) const override;
    Result<void> make(Strip& strip) override;
    // Without a map in step nothing is read, and this stage is where rows come from.
    [[nodiscard]] bool reads() const override { return in_step_.empty(); }

private:
    const PlacedMaps& maps_;
    const std::vector<MapInStep> in_step_;
    const Stage* const base_;
    Pool<BlendRows> rows_;
};

}  // namespace tex::inline v1
