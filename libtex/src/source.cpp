// SPDX-License-Identifier: Apache-2.0

#include <tex/file.h>

#include "stream/normal_source.h"
#include "threads/no_throw.h"

namespace tex::inline v1 {

Result<Source> read_normals(const std::string& path, const SourceOptions& options, bool base_only,
                            const Execution& execution) {
    return no_throw([&]() -> Result<Source> {
        FileMap map(path, options.read);
        return read_normals(map, options, base_only, execution);
    });
}

}  // namespace tex::inline v1
