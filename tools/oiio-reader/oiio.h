// SPDX-License-Identifier: Apache-2.0
// oiio.h: tex-reader-oiio, which decodes with OpenImageIO what neither libtex nor tex-reader knows.

#pragma once

#include "reader/reader.h"

namespace tex::reader {

bool decode_picture(const Task& task, ReaderHeader& header);

}  // namespace tex::reader
