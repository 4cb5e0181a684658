// SPDX-License-Identifier: Apache-2.0
//
// libpng reports errors by longjmp, which must not pass over a C++ object that has a destructor. So everything with one lives in
// the structs PngReader and PngWriter; the functions that call setjmp, and the callbacks that call png_error, hold plain
// values only.

#include "containers/png.h"

#include <png.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <optional>
#include <string>

#include "base/guard.h"
#include "containers/claims.h"

namespace tex {
namespace {

// What both directions keep: libpng's objects, and why they stopped.
struct PngState {
    png_structp png = nullptr;
    png_infop info = nullptr;
    char reason[128] = {};
    bool out_of_memory = false;
};

[[noreturn]] void on_error(png_structp png, png_const_charp message) {
    auto* state = static_cast<PngState*>(png_get_error_ptr(png));
    std::strncpy(state->reason, message, sizeof state->reason - 1);
    png_longjmp(png, 1);
}

void on_warning(png_structp, png_const_charp) {}

png_voidp on_allocate(png_structp png, png_alloc_size_t size) {
    void* memory = std::malloc(size);
    if (memory == nullptr) static_cast<PngState*>(png_get_mem_ptr(png))->out_of_memory = true;
    return memory;
}

void on_free(png_structp, png_voidp memory) { std::free(memory); }

// -- reading -----------------------------------------------------------------------------------------------

struct PngReader : PngState {
    explicit PngReader(InputFile& input) : file(input), buffer(std::size_t{1} << 16) {}
    ~PngReader() { png_destroy_read_struct(&png, &info, nullptr); }
    PngReader(const PngReader&) = delete;

    // Puts the next `count` bytes at `to`; false at the end of the file or where it cannot be read.
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

bool read_header(PngReader& reader) {
    reader.png = png_create_read_struct_2(PNG_LIBPNG_VER_STRING, static_cast<PngState*>(&reader), on_error, on_warning,
                                          static_cast<PngState*>(&reader), on_allocate, on_free);
    if (reader.png == nullptr) reader.out_of_memory = true;
    if (reader.png == nullptr || setjmp(png_jmpbuf(reader.png))) return false;
    png_structp png = reader.png;
    reader.info = png_create_info_struct(png);
    if (reader.info == nullptr) png_error(png, "out of memory");
    png_set_read_fn(png, &reader, on_read);
    png_set_crc_action(png, PNG_CRC_ERROR_QUIT, PNG_CRC_ERROR_QUIT);
    // Only IHDR, PLTE, tRNS, IDAT and IEND mean something here; the rest is not even parsed.
    png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_NEVER, nullptr, -1);
    // Limits are ours to check, with reasons of our own, once the header has proved sound.
    png_set_user_limits(png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
    png_read_info(png, reader.info);
    reader.width = png_get_image_width(png, reader.info);
    reader.height = png_get_image_height(png, reader.info);
    reader.color_type = png_get_color_type(png, reader.info);
    reader.bit_depth = png_get_bit_depth(png, reader.info);
    reader.file_row_bytes = static_cast<std::int64_t>(png_get_rowbytes(png, reader.info));
    return true;
}

// Palettes become colours, tRNS becomes alpha, and grey of 1, 2 and 4 bits becomes 8 bits by multiplication (by 255, 85 or
// 17), so that code / 255 is still exactly v / (2^n - 1).
bool start_rows(PngReader& reader) {
    if (setjmp(png_jmpbuf(reader.png))) return false;
    png_set_expand(reader.png);
    reader.passes = png_set_interlace_handling(reader.png);
    png_read_update_info(reader.png, reader.info);
    reader.channels = png_get_channels(reader.png, reader.info);
    reader.sample_bits = png_get_bit_depth(reader.png, reader.info);
    return true;
}

// Rows [first, end) of `image` from rows of bytes.
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

// A file without its end is damaged.
bool decode_end(PngReader& reader) {
    if (setjmp(png_jmpbuf(reader.png))) return false;
    png_read_end(reader.png, nullptr);
    return true;
}

class PngRows final : public RowSource {
public:
    explicit PngRows(InputFile& file) : reader_(file) {}

    // Reads the header; the rows come next.
    Result<void> open(const ReadOptions& options);

    [[nodiscard]] bool is_sequential() const override { return reader_.passes == 1; }
    Result<void> decode(int, int count, std::byte* rows) override {
        if (!decode_rows(reader_, count, reinterpret_cast<png_byte*>(rows), row_bytes())) return reader_.error();
        return {};
    }
    Result<void> finish() override {
        if (!decode_end(reader_)) return reader_.error();
        return {};
    }
    void store(const std::byte* rows, int first, int end, Image& image) const override {
        const auto* bytes = reinterpret_cast<const png_byte*>(rows);
        reader_.sample_bits == 16 ? store_rows16(bytes, first, end, image) : store_rows8(bytes, first, end, image);
    }
    Result<Image> read_all() override;

private:
    PngReader reader_;
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
    describe(*extent, channel_names(reader_.channels),
             static_cast<std::size_t>(extent->width) * static_cast<std::size_t>(reader_.channels * reader_.sample_bits / 8));
    describe_samples(SampleKind::unorm, reader_.color_type == PNG_COLOR_TYPE_PALETTE ? 8 : reader_.bit_depth);
    return {};
}

Result<Image> PngRows::read_all() {
    const int height = extent().height;
    Image image = make_image(extent(), names());
    image.bits = bits();
    // All rows where they are interlaced, else one at a time.
    const int held = is_sequential() ? 1 : height;
    std::vector<std::byte> rows(row_bytes() * static_cast<std::size_t>(held));
    for (int j = 0; j < height; j += held) {
        for (int pass = 0; pass < reader_.passes; ++pass) {
            if (Result<void> decoded = decode(j, held, rows.data()); !decoded) return decoded.error();
        }
        store(rows.data(), j, j + held, image);
    }
    if (Result<void> ended = finish(); !ended) return ended.error();
    return image;
}

}  // namespace

bool is_png(std::span<const std::byte> head) {
    // The first four bytes: what transfers as text damage are the bytes after them.
    constexpr unsigned char kMark[4] = {0x89, 'P', 'N', 'G'};
    return head.size() >= sizeof kMark && std::memcmp(head.data(), kMark, sizeof kMark) == 0;
}

Result<std::unique_ptr<RowSource>> open_png(InputFile& file, const ReadOptions& options) {
    return guarded([&]() -> Result<std::unique_ptr<RowSource>> {
        auto rows = std::make_unique<PngRows>(file);
        if (const Result<void> opened = rows->open(options); !opened) return opened.error();
        return std::unique_ptr<RowSource>(std::move(rows));
    });
}

Result<Image> read_png(InputFile& file, const ReadOptions& options) {
    return guarded([&]() -> Result<Image> {
        const Result<std::unique_ptr<RowSource>> rows = open_png(file, options);
        if (!rows) return rows.error();
        return (*rows)->read_all();
    });
}

// -- writing -----------------------------------------------------------------------------------------------

namespace {

// After an adaptive filter a normal map holds hardly any repetition that deflate could find, so run lengths alone give the same size as zlib's
// level 6, two to five times as fast (measured on baked and on painted maps, 8 and 16 bits).
constexpr int kStrategy = Z_RLE;
constexpr int kFilters = PNG_ALL_FILTERS;

struct PngWriter : PngState {
    PngWriter() = default;
    ~PngWriter() { png_destroy_write_struct(&png, &info); }
    PngWriter(const PngWriter&) = delete;

    bool append(png_const_bytep data, std::size_t count);

    std::vector<std::byte> bytes;
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

void on_write(png_structp png, png_bytep data, std::size_t count) {
    if (!static_cast<PngWriter*>(png_get_io_ptr(png))->append(data, count)) png_error(png, "out of memory");
}

void on_flush(png_structp) {}

// `palette` is null but for indexed colours.
bool write_rows(PngWriter& writer, const Level& level, int color_type, int bits, std::size_t row_bytes, const std::vector<png_color>* palette) {
    writer.png = png_create_write_struct_2(PNG_LIBPNG_VER_STRING, static_cast<PngState*>(&writer), on_error, on_warning,
                                           static_cast<PngState*>(&writer), on_allocate, on_free);
    if (writer.png == nullptr) writer.out_of_memory = true;
    if (writer.png == nullptr || setjmp(png_jmpbuf(writer.png))) return false;
    png_structp png = writer.png;
    writer.info = png_create_info_struct(png);
    if (writer.info == nullptr) png_error(png, "out of memory");
    png_set_write_fn(png, &writer, on_write, on_flush);
    png_set_user_limits(png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
    png_set_compression_strategy(png, palette == nullptr ? kStrategy : Z_DEFAULT_STRATEGY);
    png_set_filter(png, PNG_FILTER_TYPE_BASE, palette == nullptr ? kFilters : PNG_FILTER_NONE);
    png_set_IHDR(png, writer.info, static_cast<png_uint_32>(level.extent.width),
                 static_cast<png_uint_32>(level.extent.height), bits, color_type, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_BASE, PNG_FILTER_TYPE_BASE);
    if (palette != nullptr) png_set_PLTE(png, writer.info, palette->data(), static_cast<int>(palette->size()));
    png_write_info(png, writer.info);
    if (bits == 16) png_set_swap(png);  // levels are little-endian, PNG is big-endian
    for (int j = 0; j < level.extent.height; ++j) {
        const std::byte* row = level.bytes.data() + static_cast<std::size_t>(j) * row_bytes;
        png_write_row(png, reinterpret_cast<png_const_bytep>(row));
    }
    png_write_end(png, writer.info);
    return true;
}

// The colour type of a format, or -1.
int png_color_type(const FormatInfo& format) {
    if (format.sample != SampleKind::unorm || format.block != 1) return -1;
    switch (format.channels) {
        case 1: return PNG_COLOR_TYPE_GRAY;
        case 3: return PNG_COLOR_TYPE_RGB;
        case 4: return PNG_COLOR_TYPE_RGBA;
        default: return -1;
    }
}

Result<std::vector<std::byte>> written(PngWriter& writer, bool is_written) {
    if (is_written) return std::move(writer.bytes);
    if (writer.out_of_memory) return out_of_memory_error();
    return Error{ErrorCode::unsupported, {}, std::string("PNG cannot be written: ") + writer.reason};
}

}  // namespace

Result<std::vector<std::byte>> encode_png(const Texture& texture) {
    return guarded([&]() -> Result<std::vector<std::byte>> {
        const FormatInfo format = format_info(texture.format);
        const int color_type = png_color_type(format);
        if (color_type < 0 || texture.levels.empty()) {
            return Error{ErrorCode::unsupported, {},
                         "PNG holds 8 or 16 bits in one, three or four channels, not " +
                             std::string(name_of(kFormatNames, texture.format))};
        }
        const Level& level = texture.levels.front();
        PngWriter writer;
        const std::size_t row_bytes = static_cast<std::size_t>(level.extent.width) * format.block_bytes;
        return written(writer, write_rows(writer, level, color_type, format.bits, row_bytes, nullptr));
    });
}

Result<std::vector<std::byte>> encode_indexed_png(const Level& indices, const std::vector<PngColor>& palette) {
    return guarded([&]() -> Result<std::vector<std::byte>> {
        std::vector<png_color> colors;
        for (const PngColor& color : palette) colors.push_back({color.r, color.g, color.b});
        PngWriter writer;
        return written(writer, write_rows(writer, indices, PNG_COLOR_TYPE_PALETTE, 8,
                                          static_cast<std::size_t>(indices.extent.width), &colors));
    });
}

}  // namespace tex
