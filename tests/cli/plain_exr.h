// SPDX-License-Identifier: Apache-2.0
// plain_exr.h: an EXR file without its compression, for comparisons of files from different builds.

#pragma once

#include <string>

namespace tex::cli {

// The header and the chunks of an EXR file of one part, the latter without ZIP, and without the table of their places.
// Releases of libdeflate compress the same texels to different bytes: that of Debian 13 differs from that of Debian 12.
// What is not such a file is returned as it is.
[[nodiscard]] std::string plain_exr(const std::string& file);

}  // namespace tex::cli
