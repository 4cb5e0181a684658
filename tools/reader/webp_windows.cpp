// SPDX-License-Identifier: Apache-2.0
// The archive for Windows is built without libwebp.

#include "decoders.h"

namespace tex::reader {
namespace {

constexpr const char* kReason = "WebP is neither read nor written on Windows; PNG holds as much";

}  // namespace

bool decode_webp(const Task& /*task*/, ReaderHeader& header) { return refuse(header, ErrorCode::unsupported, kReason); }
bool encode_webp(const Task& /*task*/, ReaderHeader& header) { return refuse(header, ErrorCode::unsupported, kReason); }

}  // namespace tex::reader
