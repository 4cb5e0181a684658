// SPDX-License-Identifier: Apache-2.0
// pack_stream.h: pack_file() row by row.

#pragma once

#include <string>

#include <tex/pipeline.h>

#include "files/input_file.h"
#include "formats/texture_rows.h"
#include "stream/row_stream.h"

namespace tex {

// How pack_file() packs what `source` says.
PackOptions pack_options(const PackFileOptions& options, Container container, const SourceInfo& source);

// The error where the source has no level options.level.
Error no_such_level(const std::string& input, int level, std::size_t levels);

// `texture` is that of `file`, which is opened once more where the first attempt fails (see pack_file()). Precondition:
// takes_strips(container). May throw std::bad_alloc.
Result<PackFileReport> pack_stream(InputFile& file, TextureRows texture, const std::string& output, Container container,
                                   const PackFileOptions& options, const Execution& execution,
                                   const StreamSizes& sizes = {});

}  // namespace tex
