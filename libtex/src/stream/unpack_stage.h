// SPDX-License-Identifier: Apache-2.0
// unpack_stage.h: turns rows of stored values into rows of normals.

#pragma once

#include <mutex>
#include <optional>
#include <vector>

#include <tex/scale.h>

#include "rows/unpack_rows.h"
#include "stream/flow.h"
#include "stream/map_inspector.h"

namespace tex {

// The channels of a map's format: their planes in the rows of a stage.
struct StoredChannels {
    const Stage* rows = nullptr;
    std::vector<std::size_t> planes;
    bool rounds = false;  // values go through round_to_texels() (picture.h)
};

// Makes the same normals as unpack() of one level, followed by scale().
class UnpackStage final : public Stage {
public:
    // Shows normals, before they are scaled, to `inspector`, which may be null.
    UnpackStage(StoredChannels channels, const Sources& sources, const UnpackRule& rule,
                const std::optional<Scaling>& scale, MapInspector* inspector);

    [[nodiscard]] std::vector<Need> needs(int first, int end) const override { return {{channels_.rows, first, end}}; }
    Result<void> make(Strip& strip) override;

private:
    // A channel of row j; null if there is none. `rounded` has room for it.
    [[nodiscard]] const float* channel(int c, int j, float* rounded) const;

    const StoredChannels channels_;
    const Sources sources_;
    const UnpackRule rule_;
    const std::optional<Scaling> scale_;
    MapInspector* const inspector_;
    std::mutex inspecting_;
};

}  // namespace tex
