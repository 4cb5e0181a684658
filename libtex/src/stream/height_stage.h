// SPDX-License-Identifier: Apache-2.0
// height_stage.h: turns rows of a picture into rows of normals: heights, blurred heights, normals.

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

// Passes rows through a filter that is 2 radius + 1 rows high. Rows arrive in the order that row_shelf.h describes. If
// they repeat, results come in that order too, but start at a later row. If the last rows come first, nothing has to
// wait: results may then begin at `first`, which is 0 or a row before it.
class HeightWindow {
public:
    HeightWindow(Extent extent, int start, int radius, Wrap wrap, std::optional<int> first = {});

    [[nodiscard]] int start() const { return start_; }  // the first row to make
    // The next row to make. If rows repeat, it may lie past the last row or before the first one.
    [[nodiscard]] int next() const { return next_; }
    [[nodiscard]] bool done() const { return next_ == start_ + extent_.height; }
    void advance() { ++next_; }

    // Whether rows [first, end) have arrived, with all rows from which those beyond the border are made.
    [[nodiscard]] bool has(int first, int end) const;

    RowShelf shelf;

private:
    const Extent extent_;
    const Wrap wrap_;
    const int start_;
    int next_;
};

// Makes the same bytes as height_field() without fill_invalid, followed by bake().
class HeightStage final : public NormalStage {
public:
    // The number of rows above and below its own row on which a normal depends.
    static int reach(const HeightOptions& options, const Gradient& gradient);

    // `last` holds the last rows of a picture that repeats: reach() rows, or all rows of a smaller picture. With it,
    // normals are made from the top.
    HeightStage(Extent extent, const HeightSource& source, const HeightOptions& options, const Gradient& gradient,
                const HeightFieldHead& head, NormalSink sink, std::optional<Image> last = {});
    ~HeightStage() override;

    // The row at which the normals begin (see row_shelf.h).
    [[nodiscard]] int start() const;

    // From the first invalid height on, heights are only counted.
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
    int row_ = 0;                // the next row of the picture
    std::optional<Image> last_;  // until the first row comes
    int known_;                  // the number of rows in last_ that are used
    bool only_counts_ = false;   // a height was invalid, so no more normals are made
    RowMaker heights_;
    std::unique_ptr<Blur> blur_;
    std::unique_ptr<HeightWindow> window_;  // of the gradient
    std::unique_ptr<BakeRows> bake_;
};

}  // namespace tex
