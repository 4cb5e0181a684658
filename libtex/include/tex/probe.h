// SPDX-License-Identifier: Apache-2.0
// probe.h: what the first bytes of a picture or texture state, without decoding it.

#pragma once

#include <string>

#include <tex/image.h>
#include <tex/image_io.h>
#include <tex/result.h>

#pragma GCC visibility push(default)
namespace tex {

// The extent of the base level of a PNG, EXR, DDS or KTX2 file.
//
// Errors: unsupported  any other type: only the reader process knows its extent, and none is started
//         others       those of read_image() that the header reveals
[[nodiscard]] Result<Extent> probe(const std::string& path, const ReadOptions& options = {});

}  // namespace tex
#pragma GCC visibility pop
