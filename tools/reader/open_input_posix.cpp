// SPDX-License-Identifier: Apache-2.0

#include "open_input.h"

#include "formats/reader/reader_protocol.h"

namespace tex::reader {
namespace {

constexpr char kInputPath[] = "/proc/self/fd/4";
static_assert(kInputDescriptor == 4);

}  // namespace

bool open_jpeg_input(jpeg_decompress_struct& codec, JpegInput& input) {
    input.file.reset(std::fopen(kInputPath, "rbe"));
    if (input.file) jpeg_stdio_src(&codec, input.file.get());
    return input.file != nullptr;
}

TIFF* open_tiff_input() { return TIFFOpen(kInputPath, "rm"); }  // m: the file may change while it is mapped

Imf::MultiPartInputFile open_exr_input(std::unique_ptr<Imf::IStream>&, int threads) {
    return {kInputPath, threads, false};
}

}  // namespace tex::reader
