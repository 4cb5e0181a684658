// SPDX-License-Identifier: Apache-2.0

#include "decoders.h"

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
    {"webp", decode_webp, encode_webp},
    {"exr", decode_exr, nullptr},
};

}  // namespace

bool read_or_write(const Task& task, ReaderHeader& header) {
    if (task.verb == "describe") return true;
    const std::string_view format = std::string_view(task.format).substr(0, task.format.find('/'));
    for (const Decoder& decoder : kDecoders) {
        const auto work = task.verb == "encode" ? decoder.encode : decoder.decode;
        if (decoder.format == format && work != nullptr) return work(task, header);
    }
    return refuse(header, ErrorCode::unsupported, "tex-reader does not know the type " + task.format);
}

}  // namespace tex::reader
