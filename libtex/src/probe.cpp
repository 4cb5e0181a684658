// SPDX-License-Identifier: Apache-2.0

#include <tex/file.h>

#include "files/input_file.h"
#include "formats/file_types.h"
#include "formats/row_source.h"
#include "threads/no_throw.h"

namespace tex::inline v1 {

Result<Extent> probe(const std::string& path, const ReadOptions& options) {
    return no_throw([&]() -> Result<Extent> {
        Result<InputFile> file = InputFile::open(path);
        if (!file) return std::move(file).error();
        if (file_type_for(*file, options).reader_name != nullptr)
            return Error{ErrorCode::unsupported, path, "only the reader process knows the extent of this type"};
        const auto rows = open_rows(*file, options);
        if (!rows) return rows.error().of(path);
        return (*rows)->extent();
    });
}

}  // namespace tex::inline v1
