// SPDX-License-Identifier: Apache-2.0

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "oiio.h"

namespace tex::reader {
namespace {

using OIIO::TypeDesc;

TypeDesc type_of(ReaderType type) {
    switch (type) {
        case ReaderType::u16: return TypeDesc::UINT16;
        case ReaderType::f16: return TypeDesc::HALF;
        case ReaderType::f32: return TypeDesc::FLOAT;
        default: return TypeDesc::UINT8;
    }
}

OIIO::ImageSpec spec_of(const ReaderHeader& picture) {
    OIIO::ImageSpec spec(picture.width, picture.height, picture.channels, type_of(picture.type));
    spec.attribute("oiio:UnassociatedAlpha", 1);  // alpha is data; RGB must not be divided by it
    if (picture.description[0] != '\0') spec.attribute("ImageDescription", picture.description);
    return spec;
}

}  // namespace

bool encode_picture(const Task& task, ReaderHeader& header) {
    ReaderHeader picture;
    if (!read_input(0, &picture, sizeof picture))
        return refuse(header, ErrorCode::bad_data, "no picture was handed over");
    const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(task.format);
    if (!output) return refuse(header, ErrorCode::unsupported, "OpenImageIO has no encoder for " + task.format);

    OIIO::Filesystem::IOVecOutput bytes;
    OIIO::ImageSpec spec = spec_of(picture);
    spec.attribute("compression", "none");
    if (!output->set_ioproxy(&bytes) || !output->open("picture." + task.format, spec)) {
        return refuse(header, ErrorCode::unsupported, output->geterror());
    }
    const std::uint64_t bytes_of_row = row_bytes(picture);
    constexpr int kStripRows = 64;
    std::vector<std::byte> strip(bytes_of_row * kStripRows);
    for (int begin = 0; begin < picture.height; begin += kStripRows) {
        const int end = std::min(begin + kStripRows, picture.height);
        if (!read_input(kReaderDataOffset + static_cast<std::uint64_t>(begin) * bytes_of_row, strip.data(),
                        static_cast<std::uint64_t>(end - begin) * bytes_of_row)) {
            return refuse(header, ErrorCode::bad_data, "the picture ends too early");
        }
        if (!output->write_scanlines(begin, end, 0, spec.format, strip.data())) {
            return refuse(header, ErrorCode::unsupported, output->geterror());
        }
    }
    if (!output->close()) return refuse(header, ErrorCode::unsupported, output->geterror());
    return put_file(header, bytes.buffer().data(), bytes.size());
}

}  // namespace tex::reader
