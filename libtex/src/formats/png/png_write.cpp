// SPDX-License-Identifier: Apache-2.0
//
// As in png.cpp, functions that call setjmp, and callbacks that call png_error, hold plain values only.

#include "formats/png/png.h"

#include <png.h>
#include <zlib.h>

#include <string>
#include <utility>

#include "formats/normal_mark.h"
#include "formats/png/png_state.h"
#include "formats/row_target.h"
#include "threads/guard.h"

namespace tex {
namespace {

// After an adaptive filter, a normal map has hardly any repetition that deflate could find. Run lengths alone therefore
// give the same size as zlib's level 6, two to five times as fast (measured on baked and on painted maps, 8 and 16
// bits).
constexpr int kStrategy = Z_RLE;
constexpr int kFilters = PNG_ALL_FILTERS;

struct PngWriter : PngState {
    PngWriter() = default;
    ~PngWriter() { png_destroy_write_struct(&png, &info); }
    PngWriter(const PngWriter&) = delete;

    bool append(png_const_bytep data, std::size_t count);
    [[nodiscard]] Error error() const;

    std::vector<std::byte> bytes;  // what libpng has written
};

bool PngWriter::append(png_const_bytep data, std::size_t count) {
    try {
        const auto* from = reinterpret_cast<const std::byte*>(data);
        bytes.insert(bytes.end(), from, from + count);
        return true;
    } catch (const std::exception&) {
        out_of_memory = true;
        return false;
    }
}

Error PngWriter::error() const {
    if (out_of_memory) return out_of_memory_error();
    return {ErrorCode::unsupported, {}, std::string("PNG cannot be written: ") + reason};
}

void on_write(png_structp png, png_bytep data, std::size_t count) {
    if (!static_cast<PngWriter*>(png_get_io_ptr(png))->append(data, count)) png_error(png, "out of memory");
}

void on_flush(png_structp) {}

// `palette` is null unless the colours are indexed. `mark` may be empty.
bool begin_rows(PngWriter& writer, Extent extent, int color_type, int bits, const std::vector<png_color>* palette,
                const std::string& mark) {
    char key[kNormalKey.size() + 1] = {};
    kNormalKey.copy(key, kNormalKey.size());
    writer.png =
        png_create_write_struct_2(PNG_LIBPNG_VER_STRING, static_cast<PngState*>(&writer), on_png_error, on_png_warning,
                                  static_cast<PngState*>(&writer), on_png_allocate, on_png_free);
    if (writer.png == nullptr) writer.out_of_memory = true;
    if (writer.png == nullptr || setjmp(png_jmpbuf(writer.png))) return false;
    png_structp png = writer.png;
    writer.info = png_create_info_struct(png);
    if (writer.info == nullptr) png_error(png, "out of memory");
    png_set_write_fn(png, &writer, on_write, on_flush);
    png_set_user_limits(png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
    png_set_compression_strategy(png, palette == nullptr ? kStrategy : Z_DEFAULT_STRATEGY);
    png_set_filter(png, PNG_FILTER_TYPE_BASE, palette == nullptr ? kFilters : PNG_FILTER_NONE);
    png_set_IHDR(png, writer.info, static_cast<png_uint_32>(extent.width), static_cast<png_uint_32>(extent.height),
                 bits, color_type, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_BASE, PNG_FILTER_TYPE_BASE);
    if (palette != nullptr) png_set_PLTE(png, writer.info, palette->data(), static_cast<int>(palette->size()));
    if (!mark.empty()) {
        png_text text = {};
        text.compression = PNG_TEXT_COMPRESSION_NONE;  // tEXt
        text.key = key;
        text.text = const_cast<char*>(mark.c_str());  // libpng copies both
        text.text_length = mark.size();
        png_set_text(png, writer.info, &text, 1);
    }
    png_write_info(png, writer.info);
    if (bits == 16) png_set_swap(png);  // levels are little-endian, PNG is big-endian
    return true;
}

bool put_rows(PngWriter& writer, const std::byte* rows, int count, std::size_t row_bytes) {
    if (setjmp(png_jmpbuf(writer.png))) return false;
    const auto total = static_cast<std::size_t>(count);
    for (std::size_t j = 0; j < total; ++j) {
        png_write_row(writer.png, reinterpret_cast<png_const_bytep>(rows + j * row_bytes));
    }
    return true;
}

bool end_rows(PngWriter& writer) {
    if (setjmp(png_jmpbuf(writer.png))) return false;
    png_write_end(writer.png, writer.info);
    return true;
}

// The colour type of a format, or -1.
int png_color_type(const FormatInfo& format) {
    if (format.sample != SampleKind::unorm || format.has_blocks()) return -1;
    switch (format.channels) {
        case 1: return PNG_COLOR_TYPE_GRAY;
        case 3: return PNG_COLOR_TYPE_RGB;
        case 4: return PNG_COLOR_TYPE_RGBA;
        default: return -1;
    }
}

class PngTarget final : public RowTarget {
public:
    PngTarget(std::size_t row_bytes, WriteBytes write) : row_bytes_(row_bytes), write_(std::move(write)) {}

    Result<void> begin(Extent extent, int color_type, int bits, const std::string& mark) {
        if (!begin_rows(writer_, extent, color_type, bits, nullptr, mark)) return writer_.error();
        return {};
    }
    Result<void> put(int, const std::byte* rows, int count) override {
        if (!put_rows(writer_, rows, count, row_bytes_)) return writer_.error();
        return hand_on();
    }
    Result<void> finish() override {
        if (!end_rows(writer_)) return writer_.error();
        return hand_on();
    }

private:
    Result<void> hand_on() {
        Result<void> written = write_(at_, writer_.bytes);
        at_ += writer_.bytes.size();
        writer_.bytes.clear();
        return written;
    }

    const std::size_t row_bytes_;
    const WriteBytes write_;
    PngWriter writer_;
    std::uint64_t at_ = 0;
};

}  // namespace

Result<std::unique_ptr<RowTarget>> open_png_target(const TextureHead& head, WriteBytes write) {
    return guarded([&]() -> Result<std::unique_ptr<RowTarget>> {
        const FormatInfo format = format_info(head.format);
        const int color_type = png_color_type(format);
        if (color_type < 0) {
            return Error{ErrorCode::unsupported,
                         {},
                         "PNG holds 8 or 16 bits in one, three or four channels, not " +
                             std::string(name_of(kFormatNames, head.format))};
        }
        const std::size_t row_bytes = static_cast<std::size_t>(head.extent.width) * format.block_bytes;
        auto target = std::make_unique<PngTarget>(row_bytes, std::move(write));
        if (const Result<void> begun = target->begin(head.extent, color_type, format.bits, normal_mark(head)); !begun) {
            return begun.error();
        }
        return std::unique_ptr<RowTarget>(std::move(target));
    });
}

Result<std::vector<std::byte>> encode_png(const Texture& texture) {
    return guarded([&] { return encode_rows(open_png_target, texture, false); });
}

Result<std::vector<std::byte>> encode_indexed_png(const Level& indices, const std::vector<PngColor>& palette) {
    return guarded([&]() -> Result<std::vector<std::byte>> {
        std::vector<png_color> colors;
        colors.reserve(palette.size());
        for (const PngColor& color : palette) colors.push_back({color.r, color.g, color.b});
        PngWriter writer;
        const Extent extent = indices.extent;
        if (!begin_rows(writer, extent, PNG_COLOR_TYPE_PALETTE, 8, &colors, {}) ||
            !put_rows(writer, indices.bytes.data(), extent.height, static_cast<std::size_t>(extent.width)) ||
            !end_rows(writer)) {
            return writer.error();
        }
        return std::move(writer.bytes);
    });
}

}  // namespace tex
