// SPDX-License-Identifier: Apache-2.0

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "decoders.h"
#include "jpeg.h"

namespace tex::reader {
namespace {

using namespace std::string_view_literals;

void put_marker(jpeg_compress_struct& codec, int marker, const std::string& data) {
    jpeg_write_marker(&codec, marker, reinterpret_cast<const JOCTET*>(data.data()), static_cast<unsigned>(data.size()));
}

std::string low_bytes(std::size_t value, int count) {
    std::string bytes;
    for (int k = 0; k < count; ++k) bytes += static_cast<char>(value >> 8 * k & 0xff);
    return bytes;
}

std::string high_bytes(std::size_t value, int count) {
    const std::string low = low_bytes(value, count);
    return {low.rbegin(), low.rend()};
}

// The description as a comment, as EXIF's ImageDescription, and as IPTC's caption: programs read one or the other.
void put_description(jpeg_compress_struct& codec, const std::string& text) {
    constexpr std::size_t kHead = 8;  // of a TIFF
    const std::size_t count = text.size() + 1;
    put_marker(codec, JPEG_COM, text + '\0');
    const std::string entry = low_bytes(0x010e, 2) + low_bytes(2, 2) + low_bytes(count, 4) + low_bytes(kHead, 4);
    put_marker(codec, JPEG_APP0 + 1,
               std::string("Exif\0\0II*\0"sv) + low_bytes(kHead + count, 4) + text + '\0' + low_bytes(1, 2) + entry +
                   low_bytes(0, 4));
    const std::string caption = std::string("\x1c\x02\x78"sv) + high_bytes(text.size(), 2) + text;
    put_marker(codec, JPEG_APP0 + 13,
               std::string("Photoshop 3.0\0008BIM\x04\x04\0\0"sv) + high_bytes(caption.size(), 4) + caption);
}

}  // namespace

// No chroma subsampling: x and y of a normal are stored in the chroma.
bool encode_jpeg(const Task& task, ReaderHeader& header) {
    ReaderHeader picture;
    if (!read_input(0, &picture, sizeof picture))
        return refuse(header, ErrorCode::bad_data, "no picture was handed over");
    JpegJob job{task, header};
    jpeg_error_mgr errors{};
    JpegCodec<jpeg_compress_struct> codec;
    codec.err = handle_errors(errors);
    codec.client_data = &job;
    jpeg_create_compress(&codec);
    unsigned char* bytes = nullptr;
    const std::unique_ptr<unsigned char*, void (*)(unsigned char**)> owner(&bytes,
                                                                           [](unsigned char** of) { std::free(*of); });
    unsigned long size = 0;
    jpeg_mem_dest(&codec, &bytes, &size);
    codec.image_width = static_cast<JDIMENSION>(picture.width);
    codec.image_height = static_cast<JDIMENSION>(picture.height);
    codec.input_components = picture.channels;
    codec.in_color_space = picture.channels == 1 ? JCS_GRAYSCALE : JCS_RGB;
    jpeg_set_defaults(&codec);
    codec.density_unit = 0;
    codec.X_density = codec.Y_density = 1;
    jpeg_set_quality(&codec, static_cast<int>(picture.quality), TRUE);
    for (int c = 0; c < codec.num_components; ++c)
        codec.comp_info[c].h_samp_factor = codec.comp_info[c].v_samp_factor = 1;
    jpeg_start_compress(&codec, TRUE);
    if (picture.description[0] != '\0') put_description(codec, picture.description);
    std::vector<JSAMPLE> row(row_bytes(picture));
    for (int j = 0; j < picture.height; ++j) {
        if (!read_input(kReaderDataOffset + static_cast<std::uint64_t>(j) * row.size(), row.data(), row.size()))
            return refuse(header, ErrorCode::bad_data, "the picture ends too early");
        JSAMPROW from = row.data();
        jpeg_write_scanlines(&codec, &from, 1);
    }
    jpeg_finish_compress(&codec);
    return put_file(header, bytes, size);
}

}  // namespace tex::reader
