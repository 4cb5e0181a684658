// SPDX-License-Identifier: Apache-2.0
// made_rows.h: the normals that a stage makes, read as the rows of an EXR file of floats would be. So the steps after
// it make the same bytes as if such a file were between them.

#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <tex/format.h>
#include <tex/normal_map.h>

#include "formats/row_source.h"
#include "formats/texture_rows.h"
#include "stream/normal_stage.h"

namespace tex {

class MadeRows final : public RowSource {
public:
    // Makes the stage, which writes to `sink`. The stage must make rows from the top.
    using MakeStage = std::function<std::unique_ptr<NormalStage>(NormalSink sink)>;
    // Changes rows 0 to count - 1 of an image before the stage gets them; may be empty.
    using Convert = std::function<Result<void>(Image& rows, int count)>;

    // The stage gets the rows of `rows`. They and `input`, their name for messages, must outlive this object. `y` is
    // the direction of y that the rows have, as a file would.
    MadeRows(RowSource& rows, const std::string& input, Extent extent, YAxis y, const MakeStage& make,
             Convert convert = {});

    Result<void> decode(int first, int count, std::byte* rows) override;
    Result<void> finish() override;
    void store(const std::byte* rows, int first, int end, Image& image) const override;

private:
    [[nodiscard]] NormalSink sink();
    Result<void> pull();

    RowSource& rows_;
    const std::string& input_;
    const YAxis y_;
    const Convert convert_;
    std::unique_ptr<NormalStage> stage_;
    NormalMap row_;                               // the row that the stage is making
    std::map<int, std::vector<std::byte>> made_;  // rows that nobody has taken yet
    Image image_;
    std::vector<std::byte> decoded_;
    int next_ = 0;  // the first row of rows_ that has not been read
    bool is_finished_ = false;
};

// What an EXR file says about normals whose y points to `y`, without levels. It states y only if that is known.
[[nodiscard]] TextureRows made_texture(YAxis y, bool y_known);

}  // namespace tex
