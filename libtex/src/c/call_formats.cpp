// SPDX-License-Identifier: Apache-2.0

#include <iterator>

#include <tex/tex.h>

#include "c/call.h"

namespace tex::inline v1 {
namespace {

// Numbers of C are those of the enumerators of C++ (those of encodings: rows/codecs.cpp).
static_assert(std::size(kFormatNames) == TEX_FORMAT_ETC1S_RGBA_UNORM + 1 &&
              static_cast<int>(Format::bc1_unorm) == TEX_FORMAT_BC1_UNORM &&
              static_cast<int>(Format::bc7_unorm) == TEX_FORMAT_BC7_UNORM &&
              static_cast<int>(Format::astc_12x12_unorm) == TEX_FORMAT_ASTC_12X12_UNORM &&
              static_cast<int>(Format::r16_unorm) == TEX_FORMAT_R16_UNORM &&
              static_cast<int>(Format::rgba32_float) == TEX_FORMAT_RGBA32_FLOAT &&
              static_cast<int>(Format::etc1s_rgba_unorm) == TEX_FORMAT_ETC1S_RGBA_UNORM);
static_assert(static_cast<int>(Component::z) == TEX_Z && static_cast<int>(Component::other) == TEX_OTHER);
static_assert(static_cast<int>(SampleKind::floating) == TEX_FLOAT && static_cast<int>(Severity::error) == TEX_ERROR);

constexpr const char* kErrorTexts[] = {
    "done",
    "a pointer is null, or an extent, a stride, a size or a range of rows does not fit",
    "an option is outside its range, or options contradict each other",
    "the values cannot be used",
    "not supported",
    "the scratch memory is too small",
    "out of memory",
    "tex_encode_prepare() has not been called for this encoding and effort",
};
static_assert(std::size(kErrorTexts) == TEX_NOT_PREPARED + 1);

}  // namespace
}  // namespace tex::inline v1

using namespace tex;

const char* tex_error_text(int32_t error) {
    return error >= 0 && error < static_cast<int32_t>(std::size(kErrorTexts)) ? kErrorTexts[error] : "unknown error";
}

const char* tex_version(void) { return version(); }

int32_t tex_get_format(int32_t format, tex_format_info* info) {
    if (info == nullptr || !is_report(info)) return TEX_BAD_ARGUMENT;
    if (!is_one_of(format, kFormatNames)) return TEX_BAD_OPTION;
    const FormatInfo found = format_info(static_cast<Format>(format));
    const tex_format_info made = {0,
                                  static_cast<int32_t>(found.sample),
                                  found.channels,
                                  found.bits,
                                  found.block.width,
                                  found.block.height,
                                  static_cast<int32_t>(found.block_bytes)};
    write_report(made, info);
    return TEX_OK;
}

int32_t tex_encoding_format(int32_t encoding) {
    if (!is_one_of(encoding, kEncodingNames)) return -1;
    return static_cast<int32_t>(encoding_info(static_cast<Encoding>(encoding)).format);
}

size_t tex_row_bytes(int32_t format, int32_t width) {
    if (!is_one_of(format, kFormatNames) || !is_extent(width, 1)) return 0;
    return level_bytes(static_cast<Format>(format), {width, 1});
}

size_t tex_level_bytes(int32_t format, int32_t width, int32_t height) {
    if (!is_one_of(format, kFormatNames) || !is_extent(width, height)) return 0;
    return level_bytes(static_cast<Format>(format), {width, height});
}
