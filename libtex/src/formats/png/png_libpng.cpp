// SPDX-License-Identifier: Apache-2.0
//
// libpng reports errors by longjmp, which must not skip the destructor of a C++ object. All objects that have a
// destructor are therefore in the class LibpngReader and, in png_write.cpp, in PngWriter. The functions that call
// setjmp, and the callbacks that call png_error, hold plain values only.

#include "formats/png/png_libpng.h"

#include <png.h>

#include <algorithm>
#include <cstring>

#include "formats/normal_mark.h"
#include "formats/png/png_exif.h"
#include "formats/size_limits.h"
#include "threads/no_throw.h"

namespace tex::inline v1 {
namespace {

constexpr png_byte kTextChunk[] = "tEXt";
constexpr png_byte kExifChunk[] = "eXIf";

}  // namespace

void LibpngReader::on_read(png_structp png, png_bytep data, std::size_t count) {
    auto* reader = static_cast<LibpngReader*>(png_get_io_ptr(png));
    if (!reader->input_.take(data, count)) png_error(png, "the file ends too early");
    // libpng reads the header of a chunk at once.
    if (count == sizeof reader->chunk_header_) std::memcpy(reader->chunk_header_, data, count);
}

Error LibpngReader::error() const {
    if (out_of_memory) return out_of_memory_error();
    if (input_.error()) return *input_.error();
    return {ErrorCode::bad_data, file_.path(), std::string("damaged PNG: ") + reason};
}

bool LibpngReader::read_header() {
    auto* state = static_cast<PngState*>(this);
    png = png_create_read_struct_2(PNG_LIBPNG_VER_STRING, state, on_png_error, on_png_warning, state, on_png_allocate,
                                   on_png_free);
    if (png == nullptr) out_of_memory = true;
    if (png == nullptr || setjmp(png_jmpbuf(png))) return false;
    info = png_create_info_struct(png);
    if (info == nullptr) png_error(png, "out of memory");
    png_set_read_fn(png, this, on_read);
    png_set_crc_action(png, PNG_CRC_ERROR_QUIT, PNG_CRC_ERROR_QUIT);
    // Only IHDR, PLTE, tRNS, IDAT, IEND, and the text and the EXIF data before the texels have an effect; other chunks
    // are not parsed. libpng keeps the bytes of the EXIF data.
    png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_NEVER, nullptr, -1);
    png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_AS_DEFAULT, kTextChunk, 1);
    png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_ALWAYS, kExifChunk, 1);
    // libtex checks the limits itself, with its own reasons, after the header has been checked.
    png_set_user_limits(png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
    constexpr png_alloc_size_t kOwn = 1 << 20;  // libpng's own structures
    most_bytes = static_cast<png_alloc_size_t>(*file_.size()) + kOwn;
    png_read_info(png, info);
    most_bytes = std::numeric_limits<png_alloc_size_t>::max();
    png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_NEVER, kTextChunk, 1);
    png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_NEVER, kExifChunk, 1);
    width_ = png_get_image_width(png, info);
    height_ = png_get_image_height(png, info);
    file_row_bytes_ = static_cast<std::int64_t>(png_get_rowbytes(png, info));
    return true;
}

// Copies what decides about the texels out of libpng.
void LibpngReader::describe() {
    const int color_type = png_get_color_type(png, info);
    kind_.is_palette = color_type == PNG_COLOR_TYPE_PALETTE;
    kind_.channels = png_get_channels(png, info);
    kind_.bit_depth = png_get_bit_depth(png, info);
    is_interlaced_ = png_get_interlace_type(png, info) != PNG_INTERLACE_NONE;
    png_colorp colors = nullptr;
    png_bytep alpha = nullptr;
    png_color_16p hidden = nullptr;
    int color_count = 0, alpha_count = 0;
    png_get_tRNS(png, info, &alpha, &alpha_count, &hidden);
    kind_.has_transparency = alpha_count > 0;
    if (kind_.is_palette) {
        png_get_PLTE(png, info, &colors, &color_count);
        for (int k = 0; k < 256; ++k) {
            PngKind::Color& color = kind_.palette[static_cast<std::size_t>(k)];
            if (k < color_count) color = {colors[k].red, colors[k].green, colors[k].blue, 0};
            color[3] = k < alpha_count ? alpha[k] : 255;
        }
    } else if (kind_.has_transparency && kind_.channels == 1) {
        kind_.hidden = {hidden->gray, 0, 0};
    } else if (kind_.has_transparency) {
        kind_.hidden = {hidden->red, hidden->green, hidden->blue};
    }
    png_textp texts = nullptr;
    const int count = png_get_text(png, info, &texts, nullptr);
    for (int k = count; k-- > 0;) {
        if (texts[k].key == kNormalKey) normal_mark_ = {texts[k].text, texts[k].text_length};
    }
    png_unknown_chunkp kept = nullptr;
    if (png_get_unknown_chunks(png, info, &kept) > 0)
        orientation_ = png_orientation({reinterpret_cast<const char*>(kept[0].data), kept[0].size});
}

Result<void> LibpngReader::open(const ReadOptions& options) {
    if (Result<void> settled = file_.settle(largest_file(options)); !settled) return settled;
    if (!read_header()) return error();
    const double decoded = static_cast<double>(height_) * static_cast<double>(file_row_bytes_ + 1);
    const Extent claim{static_cast<int>(width_), static_cast<int>(height_)};
    if (Result<void> ok = check_claim(file_.path(), claim, decoded, *file_.size(), kDeflateRatio); !ok) return ok;
    const Result<Extent> extent = claimed_extent(file_.path(), width_, height_, options);
    if (!extent) return extent.error();
    extent_ = *extent;
    describe();
    if (orientation_ == 1) {
        const Result<int> later = png_orientation_at_end(file_);
        if (!later) return later.error();
        orientation_ = *later;
    }
    return {};
}

std::uint32_t LibpngReader::first_length() const { return png_get_uint_32(chunk_header_); }

bool LibpngReader::start_rows() {
    if (setjmp(png_jmpbuf(png))) return false;
    png_set_expand(png);
    passes_ = png_set_interlace_handling(png);
    png_read_update_info(png, info);
    return true;
}

Result<void> LibpngReader::start() {
    if (!start_rows()) return error();
    return {};
}

bool LibpngReader::decode_rows(int count, std::size_t row_bytes, png_byte* rows) {
    if (setjmp(png_jmpbuf(png))) return false;
    const auto total = static_cast<std::size_t>(count);
    for (std::size_t j = 0; j < total; ++j) png_read_row(png, rows + j * row_bytes, nullptr);
    return true;
}

Result<void> LibpngReader::decode(int count, std::size_t row_bytes, std::byte* rows) {
    if (!decode_rows(count, row_bytes, reinterpret_cast<png_byte*>(rows))) return error();
    return {};
}

// A file without its end chunk is damaged.
bool LibpngReader::decode_end() {
    if (setjmp(png_jmpbuf(png))) return false;
    png_read_end(png, nullptr);
    return true;
}

Result<void> LibpngReader::finish() {
    if (!decode_end()) return error();
    return {};
}

}  // namespace tex::inline v1
