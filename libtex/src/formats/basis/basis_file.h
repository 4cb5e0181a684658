// SPDX-License-Identifier: Apache-2.0
// basis_file.h: .basis files, the own container of Basis Universal. The same texels are read from KTX2.

#pragma once

#include <memory>
#include <string_view>

#include <tex/file.h>
#include <tex/types.h>

#include "files/input_file.h"
#include "formats/row_source.h"

namespace tex::inline v1 {

// The signature, and the version that all such files state.
inline constexpr std::string_view kBasisMagic("sB\x13\0", 4);

// Errors: unsupported, always: the reason names the program that converts the file.
Result<std::unique_ptr<RowSource>> refuse_basis(InputFile& file, const ReadOptions& options);

}  // namespace tex::inline v1
