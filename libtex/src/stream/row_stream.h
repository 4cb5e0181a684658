// SPDX-License-Identifier: Apache-2.0
// row_stream.h: the rows of a picture to the strips of a file, whatever makes normals of them.

#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include <tex/execution.h>
#include <tex/result.h>

#include "formats/row_source.h"
#include "stream/level_stage.h"
#include "stream/normal_stage.h"
#include "stream/roughness_stage.h"
#include "stream/strip_writer.h"
#include "stream/strips.h"

namespace tex {

// How a picture is cut up; the bytes do not depend on it.
struct StreamSizes {
    int strip_texels = 1 << 15;            // enough to pay for passing a strip on, few enough to stay in a cache
    std::int64_t worth_threads = 1 << 17;  // pictures of fewer texels are done before a second thread would have begun,
    int strip_texels_alone = 1 << 14;      // and in strips that stay in the cache of one processor
};

class RowStream {
public:
    // The picture is level `first` of the file, and `levels` levels are made of it, itself included. `input` stands in
    // messages. All must outlive the stream.
    RowStream(RowSource& rows, const std::string& input, int first, int levels, StripWriter& writer,
              const Execution& execution, const StreamSizes& sizes);
    ~RowStream();

    // Where the stage puts its rows.
    [[nodiscard]] NormalSink sink();
    // Where the levels below the picture go.
    [[nodiscard]] Strips& strips();
    // Where the roughness of so many levels goes, where there is any. To be called once.
    [[nodiscard]] Strips& roughness_strips(int levels);
    // Changes rows 0 to count - 1 of each image that was read, before the stage gets them; several threads may call at
    // once.
    void convert(std::function<Result<void>(Image& rows, int count)> change);
    // Is shown each strip when it has been written; several threads may call at once. May throw std::bad_alloc.
    void watch(std::function<void(const Strip& strip)> seen);

    // Brings all rows to `stage`, what it makes to `levels` and to `roughness` (which may be null), and the strips of
    // all to the writer. Errors: those of reading, which name the file; the stage's; those of writing; cancelled.
    Result<void> run(NormalStage& stage, LevelStage& levels, RoughnessStage* roughness = nullptr);

private:
    struct Work;
    std::unique_ptr<Work> work_;
};

// `error`, an option that does not fit the picture; but a picture that is damaged as well is damaged first.
// Precondition: no row has been decoded yet.
Error after_all_rows(RowSource& rows, const std::string& input, const Error& error);

}  // namespace tex
