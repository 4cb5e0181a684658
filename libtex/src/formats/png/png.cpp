// SPDX-License-Identifier: Apache-2.0
//
// libpng reports errors by longjmp, which must not skip the destructor of a C++ object. All objects that have a
// destructor are therefore in the structs PngReader and, in png_write.cpp, PngWriter. The functions that call setjmp,
// and the callbacks that call png_error, hold plain values only.

#include "formats/png/png.h"

#include <png.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <optional>
#include <string>

#include "formats/claims.h"
#include "formats/normal_mark.h"
#include "formats/png/png_state.h"
#include "threads/guard.h"

namespace tex {
namespace {

// -- reading -----------------------------------------------------------------------------------------------

struct PngReader : PngState {
    explicit PngReader(InputFile& input) : file(input), buffer(std::size_t{1} << 16) {}
    ~PngReader() { png_destroy_read_struct(&png, &info, nullptr); }
    PngReader(const PngReader&) = delete;

    // Puts the next `count` bytes at `to`; false if the file ends before them or cannot be read.
    bool take(png_bytep to, std::size_t count);
    [[nodiscard]] Error error() const;

    InputFile& file;
    std::vector<std::byte> buffer;  // libpng asks for a few bytes at a time
    std::size_t begin = 0;
    std::size_t end = 0;
    std::optional<Error> io;

    int color_type = 0;
    int bit_depth = 0;    // in the file
    int sample_bits = 0;  // as decoded: 8 or 16
    int channels = 0;     // as decoded
    int passes = 1;
    std::int64_t width = 0;
    std::int64_t height = 0;
    std::int64_t file_row_bytes = 0;
};

bool PngReader::take(png_bytep to, std::size_t count) {
    while (count > 0) {
        if (begin == end) {
            begin = 0;
            end = 0;
            const Result<std::size_t> got = guarded([&] { return file.read(buffer.data(), buffer.size()); });
            if (!got) io = got.error();
            if (!got || *got == 0) return false;
            end = *got;
        }
        const std::size_t n = std::min(count, end - begin);
        std::memcpy(to, buffer.data() + begin, n);
        begin += n;
        to += n;
        count -= n;
    }
    return true;
}

Error PngReader::error() const {
    if (out_of_memory) return out_of_memory_error();
    if (io) return *io;
    return {ErrorCode::bad_data, file.path(), std::string("damaged PNG: ") + reason};
}

void on_read(png_structp png, png_bytep data, std::size_t count) {
    if (!static_cast<PngReader*>(png_get_io_ptr(png))->take(data, count)) png_error(png, "the file ends too early");
}

constexpr png_byte kTextChunk[] = "tEXt";

bool read_header(PngReader& reader) {
    reader.png =
        png_create_read_struct_2(PNG_LIBPNG_VER_STRING, static_cast<PngState*>(&reader), on_png_error, on_png_warning,
                                 static_cast<PngState*>(&reader), on_png_allocate, on_png_free);
    if (reader.png == nullptr) reader.out_of_memory = true;
    if (reader.png == nullptr || setjmp(png_jmpbuf(reader.png))) return false;
    png_structp png = reader.png;
    reader.info = png_create_info_struct(png);
    if (reader.info == nullptr) png_error(png, "out of memory");
    png_set_read_fn(png, &reader, on_read);
    png_set_crc_action(png, PNG_CRC_ERROR_QUIT, PNG_CRC_ERROR_QUIT);
    // Only IHDR, PLTE, tRNS, IDAT, IEND and the text before the texels have an effect; other chunks are not parsed.
    png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_NEVER, nullptr, -1);
    png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_AS_DEFAULT, kTextChunk, 1);
    // libtex checks the limits itself, with its own reasons, after the header has been checked.
    png_set_user_limits(png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
    png_read_info(png, reader.info);
    png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_NEVER, kTextChunk, 1);
    reader.width = png_get_image_width(png, reader.info);
    reader.height = png_get_image_height(png, reader.info);
    reader.color_type = png_get_color_type(png, reader.info);
    reader.bit_depth = png_get_bit_depth(png, reader.info);
    reader.file_row_bytes = static_cast<std::int64_t>(png_get_rowbytes(png, reader.info));
    return true;
}

// The mark of libtex in the text before the texels; empty if there is none.
std::string mark_of(PngReader& reader) {
    png_textp texts = nullptr;
    const int count = png_get_text(reader.png, reader.info, &texts, nullptr);
    for (int k = 0; k < count; ++k) {
        if (texts[k].key == kNormalKey) return {texts[k].text, texts[k].text_length};
    }
    return {};
}

// Palettes become colours, tRNS becomes alpha, and grey of 1, 2 and 4 bits becomes 8 bits by multiplication (by 255, 85
// or 17), so that code / 255 is still exactly v / (2^n - 1).
bool start_rows(PngReader& reader) {
    if (setjmp(png_jmpbuf(reader.png))) return false;
    png_set_expand(reader.png);
    reader.passes = png_set_interlace_handling(reader.png);
    png_read_update_info(reader.png, reader.info);
    reader.channels = png_get_channels(reader.png, reader.info);
    reader.sample_bits = png_get_bit_depth(reader.png, reader.info);
    return true;
}

// Converts rows of bytes to rows [first, end) of `image`.
void store_rows8(const png_byte* rows, int first, int end, Image& image) {
    static constexpr std::array<float, 256> kValues = [] {
        std::array<float, 256> values{};
        for (std::size_t v = 0; v < 256; ++v) values[v] = static_cast<float>(v) / 255.0f;
        return values;
    }();
    const std::size_t channels = image.planes.size();
    const auto width = static_cast<std::size_t>(image.extent().width);
    for (int j = first; j < end; ++j, rows += channels * width) {
        for (std::size_t c = 0; c < channels; ++c) {
            float* to = image.planes[c].row(j);
            const png_byte* p = rows + c;
            for (std::size_t i = 0; i < width; ++i, p += channels) to[i] = kValues[*p];
        }
    }
}

void store_rows16(const png_byte* rows, int first, int end, Image& image) {
    const std::size_t channels = image.planes.size();
    const auto width = static_cast<std::size_t>(image.extent().width);
    for (int j = first; j < end; ++j, rows += 2 * channels * width) {
        for (std::size_t c = 0; c < channels; ++c) {
            float* to = image.planes[c].row(j);
            const png_byte* p = rows + 2 * c;
            for (std::size_t i = 0; i < width; ++i, p += 2 * channels) {
                to[i] = static_cast<float>(p[0] << 8 | p[1]) / 65535.0f;
            }
        }
    }
}

bool decode_rows(PngReader& reader, int count, png_byte* rows, std::size_t row_bytes) {
    if (setjmp(png_jmpbuf(reader.png))) return false;
    const auto total = static_cast<std::size_t>(count);
    for (std::size_t j = 0; j < total; ++j) png_read_row(reader.png, rows + j * row_bytes, nullptr);
    return true;
}

// A file without its end chunk is damaged.
bool decode_end(PngReader& reader) {
    if (setjmp(png_jmpbuf(reader.png))) return false;
    png_read_end(reader.png, nullptr);
    return true;
}

class PngRows final : public RowSource {
public:
    explicit PngRows(InputFile& file) : reader_(file) {}

    // Reads the header; decode() can then read the rows.
    Result<void> open(const ReadOptions& options);

    [[nodiscard]] bool can_peek() const override { return is_interlaced(); }
    Result<void> decode(int first, int count, std::byte* rows) override;
    Result<void> finish() override {
        if (!decode_end(reader_)) return reader_.error();
        return {};
    }
    void store(const std::byte* rows, int first, int end, Image& image) const override {
        const auto* bytes = reinterpret_cast<const png_byte*>(rows);
        reader_.sample_bits == 16 ? store_rows16(bytes, first, end, image) : store_rows8(bytes, first, end, image);
    }

private:
    [[nodiscard]] bool is_interlaced() const { return reader_.passes > 1; }
    Result<void> decode_next(int count, std::byte* rows) {
        if (!decode_rows(reader_, count, reinterpret_cast<png_byte*>(rows), row_bytes())) return reader_.error();
        return {};
    }

    PngReader reader_;
    std::vector<std::byte> all_;  // all rows of an interlaced picture
};

Result<void> PngRows::open(const ReadOptions& options) {
    InputFile& file = reader_.file;
    if (Result<void> settled = file.settle(largest_file(options)); !settled) return settled;
    if (!read_header(reader_)) return reader_.error();
    const double decoded = static_cast<double>(reader_.height) * static_cast<double>(reader_.file_row_bytes + 1);
    const Extent claim{static_cast<int>(reader_.width), static_cast<int>(reader_.height)};
    if (Result<void> ok = check_claim(file.path(), claim, decoded, *file.size(), kDeflateRatio); !ok) return ok;
    const Result<Extent> extent = claimed_extent(file.path(), reader_.width, reader_.height, options);
    if (!extent) return extent.error();
    if (!start_rows(reader_)) return reader_.error();
    describe(
        *extent, channel_names(reader_.channels),
        static_cast<std::size_t>(extent->width) * static_cast<std::size_t>(reader_.channels * reader_.sample_bits / 8));
    describe_samples(SampleKind::unorm, reader_.color_type == PNG_COLOR_TYPE_PALETTE ? 8 : reader_.bit_depth);
    describe_normals(mark_of(reader_));
    return {};
}

// Every pass of an interlaced picture adds texels to all of its rows.
Result<void> PngRows::decode(int first, int count, std::byte* rows) {
    if (!is_interlaced()) return decode_next(count, rows);
    if (all_.empty()) {
        std::vector<std::byte> all(row_bytes() * static_cast<std::size_t>(extent().height));
        for (int pass = 0; pass < reader_.passes; ++pass) {
            if (Result<void> decoded = decode_next(extent().height, all.data()); !decoded) return decoded;
        }
        all_ = std::move(all);
    }
    std::memcpy(rows, all_.data() + row_bytes() * static_cast<std::size_t>(first),
                row_bytes() * static_cast<std::size_t>(count));
    return {};
}

}  // namespace

const char* png_version() { return png_get_libpng_ver(nullptr); }

Result<std::unique_ptr<RowSource>> open_png(InputFile& file, const ReadOptions& options) {
    return guarded([&]() -> Result<std::unique_ptr<RowSource>> {
        auto rows = std::make_unique<PngRows>(file);
        if (const Result<void> opened = rows->open(options); !opened) return opened.error();
        return std::unique_ptr<RowSource>(std::move(rows));
    });
}

}  // namespace tex
