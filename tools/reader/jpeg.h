// SPDX-License-Identifier: Apache-2.0
// jpeg.h: how libjpeg-turbo reports errors: they refuse the file and end the process, because a C library must not be
// left by an exception.

#pragma once

#include <cstdio>  // jpeglib.h needs it

#include <jpeglib.h>

#include "reader.h"

namespace tex::reader {

// What the `client_data` of a decoder or an encoder points to.
struct JpegJob {
    const Task& task;
    ReaderHeader& header;
};

// Sets up `errors` and returns its address.
jpeg_error_mgr* handle_errors(jpeg_error_mgr& errors);

}  // namespace tex::reader
