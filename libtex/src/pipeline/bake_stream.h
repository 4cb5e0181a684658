// SPDX-License-Identifier: Apache-2.0
// bake_stream.h: bake_file() row by row.

#pragma once

#include <cstdint>
#include <string>

#include <tex/pipeline.h>

#include "containers/row_source.h"

namespace tex {

// How a picture is cut up; the bytes do not depend on it.
struct StreamSizes {
    int strip_texels = 1 << 17;             // enough to pay for passing a strip on, few enough to stay in a cache
    std::int64_t worth_threads = 1 << 17;   // pictures of fewer texels are done before a second thread would have begun,
    int strip_texels_alone = 1 << 14;       // and in strips that stay in the cache of one processor
};

// Precondition: rows.is_sequential(); `container` is dds or ktx2; neither a colour space nor fill_invalid. May throw std::bad_alloc.
Result<BakeFileReport> bake_stream(RowSource& rows, const std::string& input, const std::string& output, Container container,
                                   const BakeFileOptions& options, const Execution& execution,
                                   const StreamSizes& sizes = {});

}  // namespace tex
