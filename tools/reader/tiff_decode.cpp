// SPDX-License-Identifier: Apache-2.0

#include <tiffio.h>

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "decoders.h"
#include "open_input.h"
#include "tiff_chunks.h"
#include "tiff_mask.h"
#include "tiff_tags.h"

namespace tex::reader {
namespace {

void keep_error(const char* /*module*/, const char* format, va_list values) {
    char text[512];
    std::vsnprintf(text, sizeof text, format, values);
    if (tiff_error().empty()) tiff_error() = text;
}

// libtiff passes on what libjpeg-turbo warns of, which is damage. Its own warnings, as of tags in a wrong order, are
// not.
void keep_warning(const char* module, const char* format, va_list values) {
    if (module != nullptr && std::string_view(module) == "JPEGLib") keep_error(module, format, values);
}

bool refuse_damaged(ReaderHeader& header) {
    const std::string& text = tiff_error();
    return refuse(header, ErrorCode::bad_data, "damaged: " + (text.empty() ? "a part cannot be decoded" : text));
}

// The reason why a picture is refused, or an empty text.
std::string unsupported_reason(TIFF* tiff, const TiffLayout& layout) {
    std::uint32_t depth = 1;
    TIFFGetField(tiff, TIFFTAG_IMAGEDEPTH, &depth);
    if (layout.photometric == PHOTOMETRIC_SEPARATED) return kCmykReason;
    if (depth > 1) return "volumes are not read";
    if (layout.format == SAMPLEFORMAT_COMPLEXINT || layout.format == SAMPLEFORMAT_COMPLEXIEEEFP)
        return "complex numbers are not read";
    if (TIFFIsCODECConfigured(layout.compression) == 0)
        return "TIFF compression " + std::to_string(layout.compression) + " is not supported";
    const bool is_log = layout.photometric == PHOTOMETRIC_LOGL || layout.photometric == PHOTOMETRIC_LOGLUV;
    if (is_log && layout.compression != COMPRESSION_SGILOG && layout.compression != COMPRESSION_SGILOG24)
        return "LogLuv colours that are not compressed as such are not supported";
    char text[1024] = {};
    if (layout.needs_rgb() && TIFFRGBAImageOK(tiff, text) == 0) return text;
    if (layout.is_palette() && (layout.bits > 16 || layout.format != SAMPLEFORMAT_UINT))
        return "a palette of " + std::to_string(layout.bits) + " bits is not supported";
    return {};
}

// Hands rows over, with their mask beside the channels if there is one.
class MaskedRows {
public:
    MaskedRows(const ReaderHeader& header, Canvas& canvas, TiffMask* mask)
        : canvas_(canvas), mask_(mask), sample_bytes_(reader_type_bytes(header.type)),
          channels_(static_cast<std::size_t>(header.channels)) {}

    // The next rows, of `width` texels. False if their mask is damaged.
    bool put(const std::byte* rows, std::size_t width, std::uint32_t count) {
        if (mask_ == nullptr) {
            canvas_.put(rows, static_cast<int>(count));
            return true;
        }
        const std::size_t texel = sample_bytes_ * channels_, own = texel - sample_bytes_;
        row_.resize(width * texel);
        for (std::uint32_t j = 0; j < count; ++j, rows += width * own) {
            const std::byte* mask = nullptr;
            if (!mask_->read_row(y_++, mask)) return false;
            for (std::size_t i = 0; i < width; ++i) {
                std::memcpy(&row_[i * texel], rows + i * own, own);
                std::memset(&row_[i * texel + own], mask[i] == std::byte{0} ? 0 : 0xff, sample_bytes_);
            }
            canvas_.put(row_.data(), 1);
        }
        return true;
    }

private:
    Canvas& canvas_;
    TiffMask* mask_;
    const std::size_t sample_bytes_, channels_;
    std::vector<std::byte> row_;
    std::uint32_t y_ = 0;
};

bool read_chunks(TIFF* tiff, const TiffLayout& layout, const Samples& samples, TiffMask* mask, ReaderHeader& header,
                 Canvas& canvas) {
    const std::optional<double> no_data =
        header.has_no_data != 0 ? std::optional<double>(header.no_data) : std::nullopt;
    TiffChunks chunks(tiff, layout, samples, no_data);
    if (!chunks.is_sound() || (mask != nullptr && !mask->is_sound())) return refuse_damaged(header);
    MaskedRows masked(header, canvas, mask);
    const std::size_t channels = static_cast<std::size_t>(header.channels) - (mask != nullptr ? 1 : 0);
    const std::size_t row = std::size_t{layout.width} * channels * reader_type_bytes(header.type);
    std::vector<std::byte> rows(row * std::min(layout.chunk_height, layout.height));
    for (std::uint32_t y = 0; y < layout.height; y += layout.chunk_height) {
        const std::uint32_t count = std::min(layout.chunk_height, layout.height - y);
        if (!chunks.read(y, count, rows.data()) || !masked.put(rows.data(), layout.width, count))
            return refuse_damaged(header);
    }
    canvas.end();
    return true;
}

// Colours that libtiff converts, in memory as a whole.
bool read_rgb(TIFF* tiff, const TiffLayout& layout, ReaderHeader& header, Canvas& canvas) {
    std::vector<std::uint32_t> texels(std::size_t{layout.width} * layout.height);
    TIFFSetField(tiff, TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT);  // the canvas turns the picture
    if (TIFFReadRGBAImageOriented(tiff, layout.width, layout.height, texels.data(), ORIENTATION_TOPLEFT, 1) == 0 ||
        !tiff_error().empty())
        return refuse_damaged(header);
    std::vector<std::uint8_t> row(std::size_t{layout.width} * 3);
    for (std::size_t j = 0; j < layout.height; ++j) {
        for (std::size_t i = 0; i < layout.width; ++i) {
            const std::uint32_t texel = texels[j * layout.width + i];
            row[3 * i] = static_cast<std::uint8_t>(TIFFGetR(texel));
            row[3 * i + 1] = static_cast<std::uint8_t>(TIFFGetG(texel));
            row[3 * i + 2] = static_cast<std::uint8_t>(TIFFGetB(texel));
        }
        canvas.put(row.data(), 1);
    }
    canvas.end();
    return true;
}

// Which texels hold no data: those that the mask leaves out, or, in a GeoTIFF, those whose alpha is 0.
std::unique_ptr<TiffMask> find_mask(TIFF* tiff, const TiffLayout& layout, ReaderHeader& header) {
    std::unique_ptr<TiffMask> mask = layout.needs_rgb() ? nullptr : open_mask(tiff, layout);
    if (mask != nullptr) {
        header.mask = ReaderMask::own;
        ++header.channels;
    } else if (header.stored.has_place != 0 && header.has_alpha != 0 &&
               (layout.channels == 2 || layout.channels == 4)) {
        header.mask = ReaderMask::alpha;
    }
    return mask;
}

// Whether chunks that were never written can be read as such.
bool note_chunks(TIFF* tiff, const TiffLayout& layout, ReaderHeader& header) {
    if (layout.compression == COMPRESSION_OJPEG) return true;  // whose strips need no offsets
    const ChunkCount count = count_chunks(tiff, layout);
    header.absent_chunks = count.absent;
    header.chunks = count.all;
    header.has_tiles = layout.has_tiles ? 1 : 0;
    return count.absent == 0 || !layout.needs_rgb();
}

}  // namespace

bool decode_tiff(const Task& task, ReaderHeader& header) {
    TIFFSetWarningHandler(keep_warning);
    TIFFSetErrorHandler(keep_error);
    tiff_error().clear();
    const TiffFile file(open_tiff_input());
    if (!file) return refuse_damaged(header);
    TIFF* const tiff = file.get();
    const TiffLayout layout = tiff_layout(tiff);
    if (layout.compression == COMPRESSION_JPEG) TIFFSetField(tiff, TIFFTAG_JPEGCOLORMODE, JPEGCOLORMODE_RGB);
    if (const std::string reason = unsupported_reason(tiff, layout); !reason.empty())
        return refuse(header, ErrorCode::unsupported, reason);
    Samples samples{layout.bits, layout.format, layout.photometric == PHOTOMETRIC_MINISWHITE, ReaderType::u8};
    if (!choose_type(samples)) {
        return refuse(header, ErrorCode::unsupported,
                      "samples of " + std::to_string(layout.bits) + " bits and format " +
                          std::to_string(layout.format) + " are not supported");
    }
    constexpr std::uint32_t kMost = 0x7fffffff;
    header.width = static_cast<std::int32_t>(std::min(layout.width, kMost));
    header.height = static_cast<std::int32_t>(std::min(layout.height, kMost));
    const bool is_colour = layout.needs_rgb() || layout.is_palette();
    header.channels = is_colour ? 3 : layout.channels;
    header.type = is_colour ? ReaderType::u8 : samples.type;
    const auto container = static_cast<std::uint32_t>(8 * reader_type_bytes(header.type));
    header.bits = is_colour ? 8 : std::min<std::uint32_t>(layout.bits, container);
    if (is_colour) samples = Samples{};
    if (layout.chunk_width == 0 || layout.chunk_height == 0) return refuse_damaged(header);
    name_channels(header);
    read_tags(tiff, header);
    // GDAL's value is a code of the file, where white is 0.
    if (samples.is_inverted) header.no_data = std::ldexp(1.0, layout.bits) - 1.0 - header.no_data;
    if (!note_chunks(tiff, layout, header))
        return refuse(header, ErrorCode::unsupported, "parts that were never written are not read in such colours");
    const std::unique_ptr<TiffMask> mask = find_mask(tiff, layout, header);
    header.stored.kind = static_cast<std::uint32_t>(layout.format);
    header.stored.bits = layout.bits;
    Canvas canvas(header);
    if (!canvas.begin(task)) return false;
    return layout.needs_rgb() ? read_rgb(tiff, layout, header, canvas)
                              : read_chunks(tiff, layout, samples, mask.get(), header, canvas);
}

}  // namespace tex::reader
