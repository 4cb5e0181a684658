// SPDX-License-Identifier: Apache-2.0
// unpack_stage.h: turns rows of stored values into rows of normals.

#pragma once

#include <optional>
#include <vector>

#include <tex/scale.h>

#include "formats/texture_rows.h"
#include "rows/unpack_rows.h"
#include "stream/layout_finder.h"
#include "stream/map_inspector.h"
#include "stream/normal_stage.h"

namespace tex {

// Makes the same normals as unpack() of one level, followed by scale().
class UnpackStage final : public NormalStage {
public:
    // Shows the rows to `finder` and their normals, before scaling, to `inspector`; both may be null. Precondition: the
    // rule and the sources are those of its layout.
    UnpackStage(const TextureRows& texture, Extent extent, const Sources& sources, const UnpackRule& rule,
                const std::optional<Scaling>& scale, LayoutFinder* finder, MapInspector* inspector, NormalSink sink);

    void put(const Image& rows, int count) override;

private:
    void put_row(const Image& rows, int k);

    const TextureRows& texture_;
    const Extent extent_;
    const Sources sources_;
    const UnpackRule rule_;
    const std::optional<Scaling> scale_;
    LayoutFinder* const finder_;
    MapInspector* const inspector_;
    const NormalSink sink_;
    Plane<float> rounded_;  // the channels of a row
    int row_ = 0;           // the next row
};

}  // namespace tex
