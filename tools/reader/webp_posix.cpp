// SPDX-License-Identifier: Apache-2.0
// WebP, by libwebp. What is written is lossless, with the colours of transparent texels.

#include <webp/decode.h>
#include <webp/encode.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "decoders.h"
#include "open_input.h"

namespace tex::reader {
namespace {

bool refuse_status(ReaderHeader& header, const Task& task, VP8StatusCode status) {
    switch (status) {
        case VP8_STATUS_OUT_OF_MEMORY: return refuse_memory(header, task);
        case VP8_STATUS_UNSUPPORTED_FEATURE:
            return refuse(header, ErrorCode::unsupported, "a kind of WebP that libwebp does not read");
        case VP8_STATUS_NOT_ENOUGH_DATA: return refuse(header, ErrorCode::bad_data, "damaged: the file ends too early");
        default: return refuse(header, ErrorCode::bad_data, "damaged: libwebp cannot decode it");
    }
}

}  // namespace

bool decode_webp(const Task& task, ReaderHeader& header) {
    std::vector<unsigned char> bytes;
    if (!read_whole_input(bytes)) return refuse(header, ErrorCode::bad_data, "cannot be opened");
    WebPBitstreamFeatures features;
    const VP8StatusCode known = WebPGetFeatures(bytes.data(), bytes.size(), &features);
    if (known != VP8_STATUS_OK) return refuse_status(header, task, known);
    if (features.has_animation != 0) return refuse(header, ErrorCode::unsupported, "an animation, which is not read");
    header.width = features.width;
    header.height = features.height;
    header.channels = features.has_alpha != 0 ? 4 : 3;
    header.bits = 8;
    name_channels(header);
    Canvas canvas(header);
    if (!canvas.begin(task)) return false;
    // Alpha is not multiplied into the colours.
    WebPDecoderConfig config;
    WebPInitDecoderConfig(&config);
    const std::size_t row = row_bytes(header);
    std::vector<std::uint8_t> texels(row * static_cast<std::size_t>(header.height));
    config.output.colorspace = header.channels == 4 ? MODE_RGBA : MODE_RGB;
    config.output.is_external_memory = 1;
    config.output.u.RGBA.rgba = texels.data();
    config.output.u.RGBA.stride = static_cast<int>(row);
    config.output.u.RGBA.size = texels.size();
    const VP8StatusCode decoded = WebPDecode(bytes.data(), bytes.size(), &config);
    WebPFreeDecBuffer(&config.output);
    if (decoded != VP8_STATUS_OK) return refuse_status(header, task, decoded);
    canvas.put(texels.data(), header.height);
    canvas.end();
    return true;
}

bool encode_webp(const Task& task, ReaderHeader& header) {
    constexpr int kSmallest = 6;  // of 0 to 9; 9 took 8 and 36 times as long on two maps, for 0.7 % fewer bytes at most
    ReaderHeader picture;
    if (!read_input(0, &picture, sizeof picture))
        return refuse(header, ErrorCode::bad_data, "no picture was handed over");
    WebPConfig config;
    WebPPicture webp;
    if (WebPConfigInit(&config) == 0 || WebPConfigLosslessPreset(&config, kSmallest) == 0 ||
        WebPPictureInit(&webp) == 0)
        return refuse(header, ErrorCode::unsupported, "libwebp is of another version than its headers");
    config.exact = 1;
    const std::unique_ptr<WebPPicture, void (*)(WebPPicture*)> owner(&webp, WebPPictureFree);
    webp.use_argb = 1;
    webp.width = picture.width;
    webp.height = picture.height;
    if (WebPPictureAlloc(&webp) == 0) return refuse_memory(header, task);
    std::vector<std::uint8_t> row(row_bytes(picture));
    for (int j = 0; j < picture.height; ++j) {
        if (!read_input(kReaderDataOffset + static_cast<std::uint64_t>(j) * row.size(), row.data(), row.size()))
            return refuse(header, ErrorCode::bad_data, "the picture ends too early");
        std::uint32_t* to = webp.argb + static_cast<std::ptrdiff_t>(j) * webp.argb_stride;
        const std::uint8_t* from = row.data();
        for (int i = 0; i < picture.width; ++i, from += picture.channels) {
            // WebP has no grey: one channel fills three.
            const std::uint32_t red = from[0], green = from[picture.channels >= 3 ? 1 : 0],
                                blue = from[picture.channels >= 3 ? 2 : 0];
            const std::uint32_t alpha = picture.channels == 4 ? from[3] : 255;
            to[i] = alpha << 24 | red << 16 | green << 8 | blue;
        }
    }
    WebPMemoryWriter file;
    WebPMemoryWriterInit(&file);
    const std::unique_ptr<WebPMemoryWriter, void (*)(WebPMemoryWriter*)> bytes(&file, WebPMemoryWriterClear);
    webp.writer = WebPMemoryWrite;
    webp.custom_ptr = &file;
    if (WebPEncode(&config, &webp) == 0) {
        if (webp.error_code == VP8_ENC_ERROR_OUT_OF_MEMORY || webp.error_code == VP8_ENC_ERROR_BITSTREAM_OUT_OF_MEMORY)
            return refuse_memory(header, task);
        return refuse(header, ErrorCode::unsupported,
                      "libwebp cannot encode it: error " + std::to_string(static_cast<int>(webp.error_code)));
    }
    return put_file(header, file.mem, file.size);
}

}  // namespace tex::reader
