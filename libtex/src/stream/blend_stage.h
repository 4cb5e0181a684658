// SPDX-License-Identifier: Apache-2.0
// blend_stage.h: turns rows of several maps, which arrive in step, into rows of the blended map.

#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "rows/blend_rows.h"
#include "stream/normal_stage.h"
#include "stream/row_shelf.h"
#include "stream/unpack_stage.h"

namespace tex {

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

// The unpacked rows of one map, kept as long as the result needs them.
class ArrivingMap {
public:
    ArrivingMap(const TextureRows& texture, Extent extent, const Sources& sources, const UnpackRule& rule,
                LayoutFinder* finder, MapInspector* inspector, const RowsInStep& step);
    ArrivingMap(const ArrivingMap&) = delete;
    ArrivingMap& operator=(const ArrivingMap&) = delete;

    void put(const Image& rows, int count) { unpack_.put(rows, count); }

    // Whether all rows have arrived that row j of the result needs.
    [[nodiscard]] bool is_ready(int j) const;
    [[nodiscard]] VectorRow row(int j) const;
    // To be called when rows up to j of the result have been made.
    void release(int j) { shelf_.release_before(j + 1 - step_.behind); }

private:
    [[nodiscard]] NormalSink sink();

    const Extent extent_;
    const RowsInStep step_;
    RowShelf shelf_;
    RowMaker rows_;
    std::shared_ptr<Plane<float>> row_;  // the row that is being unpacked
    UnpackStage unpack_;
};

// Makes the same normals as blend().
class BlendStage final : public NormalStage {
public:
    // `maps` read the rows of the maps in `arriving`. All of them must outlive this object.
    BlendStage(const PlacedMaps& maps, std::vector<ArrivingMap*> arriving, NormalSink sink);

    void put(const Image& rows, int count) override;

private:
    const std::vector<ArrivingMap*> arriving_;
    const NormalSink sink_;
    BlendRows blend_;
    int arrived_ = 0;  // rows
    int next_ = 0;     // the next row to make
};

}  // namespace tex
