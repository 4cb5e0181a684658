// SPDX-License-Identifier: Apache-2.0

#include <jerror.h>
#include <cstdio>
#include <cstring>

#include <algorithm>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include "decoders.h"
#include "formats/exif.h"
#include "jpeg.h"
#include "open_input.h"

namespace tex::reader {
namespace {

// Kinds of JPEG that libjpeg-turbo does not decode.
constexpr int kUnsupported[] = {JERR_BAD_PRECISION, JERR_SOF_UNSUPPORTED, JERR_ARITH_NOTIMPL, JERR_CONVERSION_NOTIMPL,
                                JERR_NOTIMPL};
// Warnings that texels are missing or wrong. Others do no harm, but for is_damage().
constexpr int kDamage[] = {JWRN_JPEG_EOF, JWRN_HIT_MARKER, JWRN_HUFF_BAD_CODE, JWRN_MUST_RESYNC};

template <std::size_t N>
bool is_one_of(const int (&codes)[N], int code) {
    return std::find(std::begin(codes), std::end(codes), code) != std::end(codes);
}

[[noreturn]] void give_up(j_common_ptr codec) {
    char text[JMSG_LENGTH_MAX] = {};
    codec->err->format_message(codec, text);
    const JpegJob& job = *static_cast<const JpegJob*>(codec->client_data);
    if (codec->err->msg_code == JERR_OUT_OF_MEMORY) {
        refuse_memory(job.header, job.task);
    } else if (is_one_of(kUnsupported, codec->err->msg_code)) {
        refuse(job.header, ErrorCode::unsupported, text);
    } else {
        refuse(job.header, ErrorCode::bad_data, std::string("damaged: ") + text);
    }
    leave(0);
}

// Bytes between two segments do no harm. After the last texel of a scan, they show that its codes were wrong, unless
// they are padding: all the same.
bool is_damage(j_common_ptr codec) {
    const JpegJob& job = *static_cast<const JpegJob*>(codec->client_data);
    if (codec->err->msg_code != JWRN_EXTRANEOUS_DATA || !job.is_in_scans) return false;
    const unsigned char* const end = reinterpret_cast<j_decompress_ptr>(codec)->src->next_input_byte;
    const unsigned char* const first = end - std::min<std::ptrdiff_t>(codec->err->msg_parm.i[0], end - job.begin);
    return std::any_of(first, end, [&](unsigned char byte) { return byte != *first; });
}

void judge_warning(j_common_ptr codec, int level) {
    if (level < 0 && (is_one_of(kDamage, codec->err->msg_code) || is_damage(codec))) give_up(codec);
}

void be_silent(j_common_ptr /*codec*/) {}

void read_markers(const jpeg_decompress_struct& codec, ReaderHeader& header) {
    for (const jpeg_marker_struct* marker = codec.marker_list; marker != nullptr; marker = marker->next) {
        const std::string_view data(reinterpret_cast<const char*>(marker->data), marker->data_length);
        if (marker->marker == JPEG_COM && header.description[0] == '\0')
            data.copy(header.description, sizeof header.description - 1);
        if (marker->marker == JPEG_APP0 + 1 && header.orientation == 1 && data.starts_with(kExifMark))
            header.orientation = exif_orientation(data.substr(kExifMark.size()));
    }
}

}  // namespace

jpeg_error_mgr* handle_errors(jpeg_error_mgr& errors) {
    jpeg_std_error(&errors);
    errors.error_exit = give_up;
    errors.emit_message = judge_warning;
    errors.output_message = be_silent;
    return &errors;
}

bool decode_jpeg(const Task& task, ReaderHeader& header) {
    JpegJob job{task, header};
    jpeg_error_mgr errors{};
    std::vector<unsigned char> bytes;
    JpegCodec<jpeg_decompress_struct> codec;
    codec.err = handle_errors(errors);
    codec.client_data = &job;
    jpeg_create_decompress(&codec);
    if (!read_whole_input(bytes)) return refuse(header, ErrorCode::bad_data, "cannot be opened");
    jpeg_mem_src(&codec, bytes.data(), static_cast<unsigned long>(bytes.size()));
    constexpr unsigned kWholeMarker = 0xffff;
    jpeg_save_markers(&codec, JPEG_COM, kWholeMarker);
    jpeg_save_markers(&codec, JPEG_APP0 + 1, kWholeMarker);
    jpeg_read_header(&codec, TRUE);
    if (codec.jpeg_color_space == JCS_CMYK || codec.jpeg_color_space == JCS_YCCK)
        return refuse(header, ErrorCode::unsupported, kCmykReason);
    jpeg_calc_output_dimensions(&codec);
    header.width = static_cast<std::int32_t>(codec.image_width);
    header.height = static_cast<std::int32_t>(codec.image_height);
    header.channels = codec.output_components;
    header.bits = 8;
    name_channels(header);
    read_markers(codec, header);
    Canvas canvas(header);
    if (!canvas.begin(task)) return false;
    job.begin = bytes.data();
    job.is_in_scans = true;
    jpeg_start_decompress(&codec);
    const std::size_t row = std::size_t{codec.output_width} * static_cast<std::size_t>(codec.output_components);
    constexpr std::size_t kStrip = std::size_t{1} << 20;
    std::vector<JSAMPLE> strip(row * std::clamp<std::size_t>(kStrip / row, 1, codec.output_height));
    while (codec.output_scanline < codec.output_height) {
        std::size_t held = 0;
        for (; held + row <= strip.size() && codec.output_scanline < codec.output_height; held += row) {
            JSAMPROW to = &strip[held];
            jpeg_read_scanlines(&codec, &to, 1);
        }
        canvas.put(strip.data(), static_cast<int>(held / row));
    }
    jpeg_finish_decompress(&codec);
    canvas.end();
    return true;
}

}  // namespace tex::reader
