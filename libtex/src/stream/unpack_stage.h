// SPDX-License-Identifier: Apache-2.0
// unpack_stage.h: turns rows of stored values into rows of normals.

#pragma once

#include <mutex>
#include <optional>
#include <vector>

#include <tex/blend.h>

#include "rows/unpack_rows.h"
#include "stream/extra_inspector.h"
#include "stream/flow.h"
#include "stream/map_inspector.h"

namespace tex::inline v1 {

// The channels of a map's format: their planes in the rows of a stage.
struct StoredChannels {
    const Stage* rows = nullptr;
    std::vector<std::size_t> planes;
    bool rounds = false;  // values go through round_to_texels() (picture.h)
};

// What happens to normals besides unpacking.
struct UnpackPlan {
    std::optional<Scaling> scale = {};
    MapInspector* inspector = nullptr;          // is shown normals before they are scaled, unless it is null
    ExtraInspector* extra_inspector = nullptr;  // is shown all channels, unless it is null
    ExtraSet takes = {};                        // what goes along beside the normals
};

// Whether each of the four channels is read.
[[nodiscard]] std::vector<bool> wanted_channels(const Sources& sources, const UnpackPlan& plan);

// Makes the same normals as unpack() of one level, followed by scale().
class UnpackStage final : public Stage {
public:
    UnpackStage(StoredChannels channels, const Sources& sources, const UnpackRule& rule, const UnpackPlan& plan);

    [[nodiscard]] std::vector<Need> needs(int first, int end) const override { return {{channels_.rows, first, end}}; }
    Result<void> make(Strip& strip) override;

private:
    void make_row(int j, const float* const (&channels)[4], Strip& strip, int k);

    const StoredChannels channels_;
    const Sources sources_;
    const UnpackRule rule_;
    const UnpackPlan plan_;
    const std::vector<bool> wanted_;  // channels
    std::mutex inspecting_;
};

}  // namespace tex::inline v1
