// SPDX-License-Identifier: Apache-2.0

#include <tiffio.h>

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

#include "decoders.h"

namespace tex::reader {
namespace {

// A file in memory, as libtiff writes it.
struct Bytes {
    std::vector<unsigned char> all;
    std::size_t at = 0;
};

Bytes& bytes_of(thandle_t handle) { return *static_cast<Bytes*>(handle); }

tmsize_t read_bytes(thandle_t handle, void* to, tmsize_t count) {
    Bytes& bytes = bytes_of(handle);
    const std::size_t got =
        std::min(static_cast<std::size_t>(count), bytes.all.size() - std::min(bytes.at, bytes.all.size()));
    if (got > 0) std::memcpy(to, &bytes.all[bytes.at], got);
    bytes.at += got;
    return static_cast<tmsize_t>(got);
}

tmsize_t write_bytes(thandle_t handle, void* from, tmsize_t count) {
    Bytes& bytes = bytes_of(handle);
    const auto size = static_cast<std::size_t>(count);
    if (bytes.all.size() < bytes.at + size) bytes.all.resize(bytes.at + size);
    if (size > 0) std::memcpy(&bytes.all[bytes.at], from, size);
    bytes.at += size;
    return count;
}

toff_t seek_bytes(thandle_t handle, toff_t offset, int from) {
    Bytes& bytes = bytes_of(handle);
    const std::size_t origin = from == SEEK_CUR ? bytes.at : from == SEEK_END ? bytes.all.size() : 0;
    bytes.at = origin + static_cast<std::size_t>(offset);
    return bytes.at;
}

toff_t size_of_bytes(thandle_t handle) { return bytes_of(handle).all.size(); }

int close_bytes(thandle_t /*handle*/) { return 0; }

constexpr int kStripRows = 32;

void describe_picture(TIFF* tiff, const ReaderHeader& picture) {
    const bool is_floating = picture.type == ReaderType::f16 || picture.type == ReaderType::f32;
    const bool is_grey = picture.channels < 3;
    TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, picture.width);
    TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, picture.height);
    TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, picture.channels);
    TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, static_cast<int>(8 * reader_type_bytes(picture.type)));
    TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, is_floating ? SAMPLEFORMAT_IEEEFP : SAMPLEFORMAT_UINT);
    TIFFSetField(tiff, TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT);
    TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
    TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, is_grey ? PHOTOMETRIC_MINISBLACK : PHOTOMETRIC_RGB);
    if (picture.channels == 4) {
        const std::uint16_t kind = EXTRASAMPLE_UNASSALPHA;  // alpha is data; RGB is not multiplied by it
        TIFFSetField(tiff, TIFFTAG_EXTRASAMPLES, 1, &kind);
    }
    TIFFSetField(tiff, TIFFTAG_COMPRESSION, COMPRESSION_ADOBE_DEFLATE);
    TIFFSetField(tiff, TIFFTAG_PREDICTOR, is_floating ? PREDICTOR_FLOATINGPOINT : PREDICTOR_HORIZONTAL);
    TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, kStripRows);
    TIFFSetField(tiff, TIFFTAG_DATETIME, "");
    if (picture.description[0] != '\0') TIFFSetField(tiff, TIFFTAG_IMAGEDESCRIPTION, picture.description);
}

}  // namespace

bool encode_tiff(const Task& /*task*/, ReaderHeader& header) {
    ReaderHeader picture;
    if (!read_input(0, &picture, sizeof picture))
        return refuse(header, ErrorCode::bad_data, "no picture was handed over");
    TIFFSetWarningHandler(nullptr);
    TIFFSetErrorHandler(nullptr);
    Bytes bytes;
    // Files of more than 4 GB have another header. Deflate makes few files larger, and none by a hundredth.
    const std::uint64_t all = row_bytes(picture) * static_cast<std::uint64_t>(picture.height);
    constexpr std::uint64_t kMostClassic = 0xf0000000;
    TIFF* const tiff = TIFFClientOpen("picture", all > kMostClassic ? "w8" : "w", &bytes, read_bytes, write_bytes,
                                      seek_bytes, close_bytes, size_of_bytes, nullptr, nullptr);
    if (tiff == nullptr) return refuse(header, ErrorCode::unsupported, "libtiff cannot encode this picture");
    describe_picture(tiff, picture);
    bool sound = true;
    const std::uint64_t row = row_bytes(picture);
    std::vector<std::byte> strip(row * kStripRows);
    for (int begin = 0; sound && begin < picture.height; begin += kStripRows) {
        const std::uint64_t size = static_cast<std::uint64_t>(std::min(kStripRows, picture.height - begin)) * row;
        if (!read_input(kReaderDataOffset + static_cast<std::uint64_t>(begin) * row, strip.data(), size))
            return refuse(header, ErrorCode::bad_data, "the picture ends too early");
        sound = TIFFWriteEncodedStrip(tiff, static_cast<std::uint32_t>(begin / kStripRows), strip.data(),
                                      static_cast<tmsize_t>(size)) >= 0;
    }
    sound = sound && TIFFFlush(tiff) == 1;
    if (!sound) return refuse(header, ErrorCode::unsupported, "libtiff cannot encode this picture");
    TIFFClose(tiff);
    return put_file(header, bytes.all.data(), bytes.all.size());
}

}  // namespace tex::reader
