// SPDX-License-Identifier: Apache-2.0

#include <tex/source.h>

#include "base/guard.h"
#include "base/input_file.h"
#include "pipeline/normal_source.h"

namespace tex {

Result<Source> read_normals(const std::string& path, const SourceOptions& options, bool base_only, const Execution& execution) {
    return guarded([&]() -> Result<Source> {
        Result<InputFile> file = InputFile::open(path);
        if (!file) return file.error();
        return read_normals(*file, options, base_only, execution);
    });
}

}  // namespace tex
