// SPDX-License-Identifier: Apache-2.0
// height_stage.h: rows of a picture to rows of normals: heights, blurred heights, normals.

#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <tex/height_field.h>

#include "rows/bake_rows.h"
#include "rows/height_source.h"
#include "stream/normal_stage.h"
#include "stream/row_shelf.h"

namespace tex {

// Rows through a filter that is 2 radius + 1 rows high. They come in the order of row_shelf.h; where they repeat,
// results come in that order too, from a later start. But where the last rows come first, so that nothing has to wait,
// results may begin at `first`, 0 or a row before it.
class HeightWindow {
public:
    HeightWindow(Extent extent, int start, int radius, Wrap wrap, std::optional<int> first = {});

    [[nodiscard]] int start() const { return start_; }  // the first row that is made
    // The row that is made next, beyond the last one or before the first one where they repeat.
    [[nodiscard]] int next() const { return next_; }
    [[nodiscard]] bool done() const { return next_ == start_ + extent_.height; }
    void advance() { ++next_; }

    // Whether rows [first, end) are there, with all that rows beyond the border are made of.
    [[nodiscard]] bool has(int first, int end) const;

    RowShelf shelf;

private:
    const Extent extent_;
    const Wrap wrap_;
    const int start_;
    int next_;
};

// The same bytes as height_field() without fill_invalid, and bake().
class HeightStage final : public NormalStage {
public:
    // How many rows above and below its own a normal depends on.
    static int reach(const HeightOptions& options, const Gradient& gradient);

    // `last` are the last rows of a picture that repeats, reach() of them or all that there are: normals then come from
    // the top.
    HeightStage(Extent extent, const HeightSource& source, const HeightOptions& options, const Gradient& gradient,
                const HeightFieldHead& head, NormalSink sink, std::optional<Image> last = {});
    ~HeightStage() override;

    // The row at which normals begin (see row_shelf.h).
    [[nodiscard]] int start() const;

    // Once a height was invalid, the others are only counted.
    void put(const Image& rows, int count) override;

    [[nodiscard]] const HeightCounts& counts() const { return counts_; }
    [[nodiscard]] Result<void> check() const override;

private:
    struct Blur;
    void begin_with(const Image& last);
    void put_row(const Image& rows, int k);
    void take_row(int j, std::shared_ptr<Plane<float>> row);
    void take_invalid(const float* row);
    void blur_row(int j, const float* row);
    void blur_column(int j);
    void put_height(int j, ShelfRow row);

    const Extent extent_;
    const HeightSource source_;
    const HeightOptions options_;
    const Gradient gradient_;
    const NormalSink sink_;
    HeightCounts counts_;
    int first_invalid_[2] = {};  // column, row
    int row_ = 0;                // of the picture, the next one
    std::optional<Image> last_;  // until the first row comes
    int known_;                  // how many rows these were
    bool only_counts_ = false;   // a height was invalid
    RowMaker heights_;
    std::unique_ptr<Blur> blur_;
    std::unique_ptr<HeightWindow> window_;  // of the gradient
    std::unique_ptr<BakeRows> bake_;
};

}  // namespace tex
