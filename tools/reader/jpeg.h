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
    const unsigned char* begin = nullptr;  // of the file that is decoded
    bool is_in_scans = false;              // texels are being decoded
};

// A codec that gives its memory back, which matters where it does not have a process of its own.
template <class Struct>
struct JpegCodec : Struct {
    JpegCodec() : Struct{} {}
    JpegCodec(const JpegCodec&) = delete;
    JpegCodec& operator=(const JpegCodec&) = delete;
    ~JpegCodec() { jpeg_destroy(reinterpret_cast<j_common_ptr>(static_cast<Struct*>(this))); }
};

// Sets up `errors` and returns its address.
jpeg_error_mgr* handle_errors(jpeg_error_mgr& errors);

}  // namespace tex::reader
