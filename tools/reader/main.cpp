// SPDX-License-Identifier: Apache-2.0
// tex-reader: decodes and encodes TIFF and JPEG, and decodes EXR, for libtex, which starts it. Do not run it by hand,
// except
//
//     tex-reader --version      prints the versions of the decoders, and whether the kernel supports the restriction of
//                               files and the filter of system calls

#include <iterator>
#include <string>

#include <tiffvers.h>

#include "decoders.h"

#define TEX_TEXT_OF(number) #number
#define TEX_TEXT(number) TEX_TEXT_OF(number)

namespace tex::reader {
namespace {

struct Decoder {
    std::string_view format;
    bool (*decode)(const Task& task, ReaderHeader& header);
    bool (*encode)(const Task& task, ReaderHeader& header);
};

constexpr Decoder kDecoders[] = {
    {"tiff", decode_tiff, encode_tiff},
    {"jpeg", decode_jpeg, encode_jpeg},
    {"exr", decode_exr, nullptr},
};

bool read_or_write(const Task& task, ReaderHeader& header) {
    if (task.verb == "describe") return true;
    const std::string_view format = std::string_view(task.format).substr(0, task.format.find('/'));
    for (const Decoder& decoder : kDecoders) {
        const auto work = task.verb == "encode" ? decoder.encode : decoder.decode;
        if (decoder.format == format && work != nullptr) return work(task, header);
    }
    return refuse(header, ErrorCode::unsupported, "tex-reader does not know the type " + task.format);
}

}  // namespace
}  // namespace tex::reader

int main(int argc, char** argv) {
    return tex::reader::run_program("tex-reader", "libtiff " TEX_TEXT(TIFFLIB_VERSION), argc, argv,
                                    tex::reader::read_or_write);
}
