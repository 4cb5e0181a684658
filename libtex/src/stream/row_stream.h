// SPDX-License-Identifier: Apache-2.0
// row_stream.h: passes the rows of a picture to the strips of a file, through any stage that makes normals.

#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
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

// How a picture is divided. The bytes of the output do not depend on it.
struct StreamSizes {
    int strip_texels = 1 << 15;            // enough to pay for passing a strip on, few enough to stay in a cache
    std::int64_t worth_threads = 1 << 17;  // smaller pictures are done before a second thread could start: they use
    int strip_texels_alone = 1 << 14;      // strips of this size, which stay in the cache of one processor
};

class RowStream {
public:
    // The picture is level `first` of the file. `levels` levels are made from it, including the picture itself.
    // Messages name the picture `input`. All parameters must outlive the stream. `made`: the extent of what the stage
    // makes, if the stage takes more rows and columns than it makes.
    RowStream(RowSource& rows, const std::string& input, int first, int levels, StripWriter& writer,
              const Execution& execution, const StreamSizes& sizes, std::optional<Extent> made = {});
    ~RowStream();

    // Where the stage writes its rows.
    [[nodiscard]] NormalSink sink();
    // Where the levels below the picture go.
    [[nodiscard]] Strips& strips();
    // Where the roughness of this number of levels goes, if there is any. To be called at most once.
    [[nodiscard]] Strips& roughness_strips(int levels);
    // Sets a function that changes rows 0 to count - 1 of each image before the stage gets them. Several threads may
    // call it at once.
    void convert(std::function<Result<void>(Image& rows, int count)> change);
    // Sets a function that is called with each strip after it has been written. Several threads may call it at once. It
    // may throw std::bad_alloc.
    void watch(std::function<void(const Strip& strip)> seen);

    // Passes all rows to `stage`, its normals to `levels` and to `roughness` (which may be null), and all strips to the
    // writer. Errors: those of reading, which name the file; those of the stage; those of writing; cancelled.
    Result<void> run(NormalStage& stage, LevelStage& levels, RoughnessStage* roughness = nullptr);

private:
    struct Work;
    std::unique_ptr<Work> work_;
};

// Returns `error`, which says that an option does not fit the picture, unless the picture is also damaged: that error
// comes first. Precondition: no row has been decoded yet.
Error after_all_rows(RowSource& rows, const std::string& input, const Error& error);

}  // namespace tex
