// SPDX-License-Identifier: Apache-2.0
// blend_stage.h: rows of several maps, in step, to rows of the blended map.

#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "rows/blend_rows.h"
#include "stream/normal_stage.h"
#include "stream/row_shelf.h"
#include "stream/unpack_stage.h"

namespace tex {

// Which rows of a map the rows of a result of the same extent need: row j those from j - behind to j + ahead, or one of
// the first `head`.
struct RowsInStep {
    int behind = 0;
    int ahead = 0;
    int head = 0;
};

// Nothing if the map, of this extent, cannot come in step with the result: it has another extent, is turned, repeats,
// is moved up or down, or shrinks.
std::optional<RowsInStep> rows_in_step(Extent source, Extent result, const UvMap& map, Wrap wrap_x, Wrap wrap_y);

// Rows of one map, unpacked, as long as the result needs them.
class ArrivingMap {
public:
    ArrivingMap(const TextureRows& texture, Extent extent, const Sources& sources, const UnpackRule& rule,
                LayoutFinder* finder, const RowsInStep& step);
    ArrivingMap(const ArrivingMap&) = delete;
    ArrivingMap& operator=(const ArrivingMap&) = delete;

    void put(const Image& rows, int count) { unpack_.put(rows, count); }

    // Whether all is there that row j of the result needs.
    [[nodiscard]] bool is_ready(int j) const;
    [[nodiscard]] VectorRow row(int j) const;
    // Rows up to j of the result have been made.
    void release(int j) { shelf_.release_before(j + 1 - step_.behind); }

private:
    [[nodiscard]] NormalSink sink();

    const Extent extent_;
    const RowsInStep step_;
    RowShelf shelf_;
    RowMaker rows_;
    std::shared_ptr<Plane<float>> row_;  // the one that is unpacked
    UnpackStage unpack_;
};

// The same normals as blend().
class BlendStage final : public NormalStage {
public:
    // `maps` take rows of those that arrive; all must outlive this.
    BlendStage(const PlacedMaps& maps, std::vector<ArrivingMap*> arriving, NormalSink sink);

    void put(const Image& rows, int count) override;

private:
    const std::vector<ArrivingMap*> arriving_;
    const NormalSink sink_;
    BlendRows blend_;
    int arrived_ = 0;  // rows
    int next_ = 0;     // the row that is made next
};

}  // namespace tex
