// SPDX-License-Identifier: Apache-2.0
// oiio.h: tex-reader-oiio, which decodes with OpenImageIO what tex-reader does not know, and encodes TGA and BMP.

#pragma once

#include "reader/reader.h"

namespace tex::reader {

bool decode_picture(const Task& task, ReaderHeader& header);
bool encode_picture(const Task& task, ReaderHeader& header);

}  // namespace tex::reader
