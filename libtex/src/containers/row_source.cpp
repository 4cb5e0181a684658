// SPDX-License-Identifier: Apache-2.0

#include "containers/row_source.h"

#include "containers/png.h"

namespace tex {

Result<std::unique_ptr<RowSource>> open_rows(InputFile& file, const ReadOptions& options) {
    Result<std::unique_ptr<RowSource>> rows = std::unique_ptr<RowSource>();
    if (is_png(file.head())) rows = open_png(file, options);
    if (rows || !rows.error().file.empty()) return rows;
    return Error{rows.error().code, file.path(), rows.error().reason};
}

}  // namespace tex
