// SPDX-License-Identifier: Apache-2.0

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cctype>
#include <cstring>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

#include "canvas.h"
#include "oiio.h"

namespace tex::reader {
namespace {

using OIIO::TypeDesc;

struct NativeType {
    TypeDesc::BASETYPE native;
    TypeDesc::BASETYPE read_as;
    ReaderType type;
};

constexpr NativeType kTypes[] = {
    {TypeDesc::UINT8, TypeDesc::UINT8, ReaderType::u8},    {TypeDesc::INT8, TypeDesc::INT8, ReaderType::s8},
    {TypeDesc::UINT16, TypeDesc::UINT16, ReaderType::u16}, {TypeDesc::INT16, TypeDesc::INT16, ReaderType::s16},
    {TypeDesc::UINT32, TypeDesc::UINT32, ReaderType::u32}, {TypeDesc::INT32, TypeDesc::INT32, ReaderType::s32},
    {TypeDesc::HALF, TypeDesc::HALF, ReaderType::f16},     {TypeDesc::FLOAT, TypeDesc::FLOAT, ReaderType::f32},
};

// The type as stored. Types that a plane cannot hold (64 bits, or a different type for each channel) are read as float.
NativeType native_type(const OIIO::ImageSpec& spec) {
    if (spec.channelformats.empty()) {
        for (const NativeType& type : kTypes) {
            if (spec.format.basetype == type.native) return type;
        }
    }
    return {TypeDesc::FLOAT, TypeDesc::FLOAT, ReaderType::f32};
}

// The reason why a picture is refused, or an empty view.
std::string_view unsupported_reason(const OIIO::ImageSpec& spec) {
    const std::string jpeg = spec.get_string_attribute("jpeg:ColorSpace");
    const bool has_black =
        std::find(spec.channelnames.begin(), spec.channelnames.end(), "K") != spec.channelnames.end();
    if (has_black || jpeg.find('K') != std::string::npos || spec.get_string_attribute("oiio:ColorSpace") == "CMYK") {
        return kCmykReason;
    }
    if (spec.deep) return kDeepReason;
    if (spec.depth > 1) return "volumes are not read";
    return {};
}

void describe(const OIIO::ImageSpec& spec, const NativeType& type, ReaderHeader& header) {
    header.width = spec.width;
    header.height = spec.height;
    header.channels = spec.nchannels;
    header.type = type.type;
    const int container = static_cast<int>(8 * reader_type_bytes(type.type));
    const int bits = spec.get_int_attribute("oiio:BitsPerSample", container);
    header.bits = static_cast<std::uint32_t>(bits >= 1 && bits <= container ? bits : container);
    header.orientation = static_cast<std::uint32_t>(spec.get_int_attribute("Orientation", 1));
    const std::string description = spec.get_string_attribute("ImageDescription");
    std::strncpy(header.description, description.c_str(), sizeof header.description - 1);
    for (int c = 0; c < std::min(spec.nchannels, kMaxReaderChannels); ++c) {
        const std::string& name = spec.channelnames[static_cast<std::size_t>(c)];
        std::strncpy(header.names[c], name.c_str(), sizeof header.names[c] - 1);
    }
}

// The number of rows to read at a time: the rows of a tile, or about 1 MiB.
int strip_rows(const OIIO::ImageSpec& spec, std::uint64_t bytes_of_row) {
    if (spec.tile_width > 0) return spec.tile_height;
    constexpr std::uint64_t kStrip = std::uint64_t{1} << 20;
    return static_cast<int>(
        std::clamp<std::uint64_t>(kStrip / bytes_of_row, 1, static_cast<std::uint64_t>(spec.height)));
}

bool read_strip(OIIO::ImageInput& input, const OIIO::ImageSpec& spec, const TypeDesc& type, int begin, int end,
                void* to) {
    const int y = spec.y + begin;
    const int y_end = spec.y + end;
    if (spec.tile_width > 0) {
        return input.read_tiles(0, 0, spec.x, spec.x + spec.width, y, y_end, spec.z, spec.z + 1, 0, spec.nchannels,
                                type, to);
    }
    return input.read_scanlines(0, 0, y, y_end, spec.z, 0, spec.nchannels, type, to);
}

// Refuses because of what OpenImageIO reports. Only its words show whether a file is damaged or of a kind that it
// cannot decode; where it is not sure, it says "corrupt", too.
bool refuse_picture(ReaderHeader& header, const std::string& message) {
    std::string words = message;
    std::transform(words.begin(), words.end(), words.begin(), [](unsigned char c) { return std::tolower(c); });
    const auto says = [&](std::string_view text) { return words.find(text) != std::string::npos; };
    if (says("corrupt") || !(says("unsupported") || says("not supported"))) {
        return refuse(header, ErrorCode::bad_data, "damaged: " + message);
    }
    // Compressions of PSD: 2 is ZIP, 3 ZIP with prediction (Adobe Photoshop File Formats Specification).
    if (says("unsupported compression 2") || says("unsupported compression 3")) {
        return refuse(header, ErrorCode::unsupported,
                      "ZIP compression in PSD is not supported; save the picture with RLE or without compression");
    }
    return refuse(header, ErrorCode::unsupported, message);
}

}  // namespace

bool decode_picture(const Task& task, ReaderHeader& header) {
    const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::create(task.format);
    if (!input) return refuse(header, ErrorCode::unsupported, "OpenImageIO has no decoder for " + task.format);
    OIIO::ImageSpec config;
    config.attribute("oiio:UnassociatedAlpha", 1);
    config.attribute("oiio:RawColor", 1);
    OIIO::ImageSpec spec;
    const std::string path = "/proc/self/fd/" + std::to_string(kInputDescriptor);
    if (!input->open(path, spec, config)) return refuse_picture(header, input->geterror());

    if (const std::string_view reason = unsupported_reason(spec); !reason.empty()) {
        return refuse(header, ErrorCode::unsupported, std::string(reason));
    }
    const NativeType type = native_type(spec);
    describe(spec, type, header);
    const std::uint64_t bytes_of_row = row_bytes(header);
    Canvas canvas(header);
    if (!canvas.begin(task)) return false;

    const int rows = strip_rows(spec, bytes_of_row);
    std::vector<std::byte> strip(bytes_of_row * static_cast<std::uint64_t>(std::min(rows, spec.height)));
    for (int begin = 0; begin < spec.height; begin += rows) {
        const int end = std::min(begin + rows, spec.height);
        // Some decoders report success but leave an error message behind.
        if (!read_strip(*input, spec, type.read_as, begin, end, strip.data()) || input->has_error()) {
            return refuse_picture(header, input->geterror());
        }
        canvas.put(strip.data(), end - begin);
    }
    canvas.end();
    return true;
}

}  // namespace tex::reader
