// SPDX-License-Identifier: Apache-2.0

#include "formats/basis/basis_file.h"

namespace tex::inline v1 {

Result<std::unique_ptr<RowSource>> refuse_basis(InputFile& file, const ReadOptions&) {
    return Error{ErrorCode::unsupported, file.path(),
                 "a .basis file is not supported; \"basisu -unpack\" makes pictures and KTX files of it"};
}

}  // namespace tex::inline v1
