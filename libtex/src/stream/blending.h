// SPDX-License-Identifier: Apache-2.0
// blending.h: the maps of a blend, opened and placed, and the rows that come of them.

#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <tex/pipeline.h>

#include "rows/blend_rows.h"
#include "stream/blend_stage.h"
#include "stream/joined_rows.h"
#include "stream/map_file.h"
#include "stream/map_inspector.h"
#include "stream/map_source.h"
#include "stream/shared_maps.h"

namespace tex {

class Blending {
public:
    // The base is a file or comes from another source. All parameters must outlive this object.
    Blending(const std::string& input, const BlendFileOptions& options);
    Blending(MapSource& base, const BlendFileOptions& options);

    // Opens all files and reads the maps that are held in memory.
    Result<void> open(const Execution& execution);
    // Prepares for another reading.
    Result<void> open_again();
    // Finds out how the maps are read. Call it before each reading.
    Result<void> prepare();
    // Reads maps whose layout depends on their texels until it is known.
    Result<void> settle_layouts();
    // To be called after each reading: false if the layout of a map was not what it seemed.
    bool was_right();

    [[nodiscard]] Extent extent() const { return extent_; }
    [[nodiscard]] const std::string& path() const { return base_.file.path(); }
    [[nodiscard]] const SourceInfo& source() { return base_.file.info(); }  // of the base
    [[nodiscard]] std::vector<SourceInfo> details() const;
    // Sets SourceInfo::y_doubtful of the base and of the details, after the last reading.
    void judge(SourceInfo& base, std::vector<SourceInfo>& details);

    // One reading of the maps: the rows of those that are read in step, and what makes normals of them.
    struct Reading {
        Reading(const BlendOptions& options, Extent extent) : maps{{}, {}, options, extent} {}

        std::deque<ArrivingMap> arriving;
        std::vector<ArrivingMap*> in_step;
        PlacedMaps maps;
        std::optional<JoinedRows> rows;
    };
    Result<std::unique_ptr<Reading>> read(const Execution& execution);

private:
    // One of the maps: its file, its place, and the rows that are needed at a time if its rows keep in step with those
    // of the result.
    struct Input {
        Input(const std::string& path, const SourceOptions& options) : file(path, options) {}
        Input(MapSource& made, const SourceOptions& options) : file(made, options) {}

        MapFile file;
        UvMap map;
        Wrap wrap_x = Wrap::repeat;
        Wrap wrap_y = Wrap::repeat;
        std::optional<RowsInStep> step;         // empty: the whole map is held in memory,
        std::shared_ptr<const HeldMap> shared;  // here, if other blends hold it, too
        std::optional<MapInspector> inspector;
    };
    Result<void> settle(Input& input, const Execution& execution);
    Result<void> open_detail(Input& input, const LayerFile& layer, const Layer& placed, const Execution& execution);
    Result<PlacedMap> place(Input& input, std::deque<ArrivingMap>& arriving, const Execution& execution);

    const BlendFileOptions& options_;
    std::deque<Input> inputs_;  // the base, then the details
    Input& base_;
    Extent extent_;
    std::vector<Layer> layers_;
};

}  // namespace tex
