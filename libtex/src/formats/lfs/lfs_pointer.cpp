// SPDX-License-Identifier: Apache-2.0

#include "formats/lfs/lfs_pointer.h"

namespace tex::inline v1 {

Result<std::unique_ptr<RowSource>> refuse_lfs_pointer(InputFile& file, const ReadOptions&) {
    return Error{ErrorCode::bad_data, file.path(),
                 "a Git LFS pointer, not the file itself; \"git lfs pull\" fetches it"};
}

}  // namespace tex::inline v1
