// SPDX-License-Identifier: Apache-2.0

#include <tex/source.h>

#include "files/input_file.h"
#include "stream/normal_source.h"
#include "threads/guard.h"

namespace tex {

Result<Source> read_normals(const std::string& path, const SourceOptions& options, bool base_only,
                            const Execution& execution) {
    return guarded([&]() -> Result<Source> {
        Result<InputFile> file = InputFile::open(path);
        if (!file) return file.error();
        return read_normals(*file, options, base_only, execution);
    });
}

}  // namespace tex
