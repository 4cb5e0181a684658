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
#include "stream/map_inspector.h"
#include "stream/settled_map.h"
#include "stream/shared_maps.h"

namespace tex::inline v1 {

class Blending {
public:
    // The base is a file or comes from another source. All parameters must outlive this object.
    Blending(MapSource& base, const BlendFileOptions& options);

    // Opens all maps, settles how they are read, and reads those that are held in memory.
    Result<void> open(const Execution& execution);
    // The data beside the normals of the base that can go along, as its options say.
    [[nodiscard]] ExtraSet extras_taken() const;
    // SettledMap::alpha_is_one() of the base.
    Result<bool> alpha_is_one() { return base_.step ? base_.settled.alpha_is_one() : Result<bool>(false); }
    // Adds stages that make the rows of the result, and these data of the base. To be called once.
    Stage& add_to(Flow& flow, ExtraSet kept = {});
    // Sets what SourceInfo says about the texels, after the last row. `accounted_for`: what of the base is not lost;
    // `kept`: what is kept, and mixed with that of details that have a mask.
    void judge(ExtraSet accounted_for, ExtraSet kept);

    [[nodiscard]] Extent extent() const { return maps_->extent; }
    [[nodiscard]] const std::string& path() const { return base_.map().path(); }
    [[nodiscard]] const SourceInfo& source() const { return base_.info; }  // of the base
    [[nodiscard]] std::vector<SourceInfo> details() const;

private:
    // One of the maps and its place; and the rows that are needed at a time if its rows keep in step with those of the
    // result.
    struct Input {
        Input(MapSource& map, const SourceOptions& options) : settled(map, options) {}
        Input(const std::string& path, const SourceOptions& options)
            : file(std::make_unique<FileMap>(path, options.read)), settled(*file, options) {}

        [[nodiscard]] MapSource& map() const { return settled.map(); }

        std::unique_ptr<FileMap> file;  // unless the map comes from elsewhere
        SettledMap settled;
        SourceInfo info;
        UvMap place;
        Wrap wrap_x = Wrap::repeat;
        Wrap wrap_y = Wrap::repeat;
        std::optional<RowsInStep> step;  // empty: the whole map is held in memory, here,
        MipChain chain;
        std::shared_ptr<const HeldMap> shared;  // or here, if other blends hold it, too
        const Stage* rows = nullptr;
        std::optional<MapInspector> inspector;
        std::optional<ExtraInspector> extra_inspector;
    };
    Result<void> settle(Input& input, const Execution& execution);
    Result<void> hold(Input& input, const Execution& execution);
    Result<void> open_base(const Execution& execution);
    Result<void> open_detail(Input& input, const LayerFile& layer, const Layer& placed, const Execution& execution);
    Result<PlacedMap> place(Input& input, const Execution& execution);

    const BlendFileOptions& options_;
    std::deque<Input> inputs_;  // the base, then the details
    Input& base_;
    Extent extent_;
    std::deque<Layer> layers_;
    std::optional<PlacedMaps> maps_;
};

}  // namespace tex::inline v1
