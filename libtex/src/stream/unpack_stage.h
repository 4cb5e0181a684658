// SPDX-License-Identifier: Apache-2.0
// unpack_stage.h: rows of stored values to rows of normals.

#pragma once

#include <optional>
#include <vector>

#include <tex/scale.h>

#include "formats/texture_rows.h"
#include "rows/unpack_rows.h"
#include "stream/layout_finder.h"
#include "stream/normal_stage.h"

namespace tex {

// The same normals as unpack() of one level, and scale().
class UnpackStage final : public NormalStage {
public:
    // `finder` is shown the rows, where it is not null. Precondition: the rule and sources are those of its layout.
    UnpackStage(const TextureRows& texture, Extent extent, const Sources& sources, const UnpackRule& rule,
                const std::optional<Scaling>& scale, LayoutFinder* finder, NormalSink sink);

    void put(const Image& rows, int count) override;

private:
    void put_row(const Image& rows, int k);

    const TextureRows& texture_;
    const Extent extent_;
    const Sources sources_;
    const UnpackRule rule_;
    const std::optional<Scaling> scale_;
    LayoutFinder* const finder_;
    const NormalSink sink_;
    Plane<float> rounded_;  // the channels of a row
    int row_ = 0;           // the next one
};

}  // namespace tex
