// SPDX-License-Identifier: Apache-2.0
// normal_stage.h: what makes rows of normals of the rows of a picture: of heights (height_stage.h), or of stored
// normals (unpack_stage.h).

#pragma once

#include <functional>

#include <tex/image.h>
#include <tex/result.h>

#include "kernels/bake.h"

namespace tex {

// Where the normals of row j go, and what happens when they are there. Rows come in the order that row_shelf.h
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

    // The next `count` rows of the picture, which are rows 0 to count - 1 of `rows`. May throw std::bad_alloc.
    virtual void put(const Image& rows, int count) = 0;

    // After the last row. Errors: bad_data.
    [[nodiscard]] virtual Result<void> check() const { return {}; }
};

}  // namespace tex
