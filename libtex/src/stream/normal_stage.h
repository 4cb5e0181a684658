// SPDX-License-Identifier: Apache-2.0
// normal_stage.h: makes rows of normals from the rows of a picture, which are heights (height_stage.h) or stored
// normals (unpack_stage.h).

#pragma once

#include <functional>

#include <tex/image.h>
#include <tex/result.h>

#include "kernels/bake.h"

namespace tex {

// Where to write the normals of row j, and what to call when they are written. Rows come in the order that row_shelf.h
// describes.
struct NormalSink {
    std::function<NormalRow(int j)> place;
    std::function<void(int j)> finish;
};

class NormalStage {
public:
    NormalStage() = default;
    NormalStage(const NormalStage&) = delete;
    NormalStage& operator=(const NormalStage&) = delete;
    virtual ~NormalStage() = default;

    // Takes the next `count` rows of the picture, which are rows 0 to count - 1 of `rows`. May throw std::bad_alloc.
    virtual void put(const Image& rows, int count) = 0;

    // To be called after the last row. Errors: bad_data.
    [[nodiscard]] virtual Result<void> check() const { return {}; }
};

}  // namespace tex
