// SPDX-License-Identifier: Apache-2.0
//
// As in png.cpp, functions that call setjmp, and callbacks that call png_error, hold plain values only.

#include "formats/png/png.h"

#include <png.h>

#include <cstring>
#include <deque>
#include <map>
#include <string>
#include <utility>

#include "formats/normal_mark.h"
#include "formats/png/png_block.h"
#include "formats/png/png_chunk.h"
#include "formats/png/png_state.h"
#include "formats/row_target.h"
#include "threads/no_throw.h"

namespace tex::inline v1 {
namespace {

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

// Writes everything before the texels. `palette` is null unless the colours are indexed. `mark` may be empty.
bool begin_file(PngWriter& writer, Extent extent, int color_type, int bits, const std::vector<png_color>* palette,
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
    return true;
}

bool put_rows(PngWriter& writer, const std::byte* rows, int count, std::size_t row_bytes) {
    if (setjmp(png_jmpbuf(writer.png))) return false;
    png_set_filter(writer.png, PNG_FILTER_TYPE_BASE, PNG_FILTER_NONE);  // neighbouring indices may differ in any way
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

// Collects rows in blocks, and writes the blocks in their order.
class PngTarget final : public RowTarget {
public:
    // `head` is what comes before the texels.
    PngTarget(const PngShape& shape, std::vector<std::byte> head, WriteBytes write)
        : shape_(shape), write_(std::move(write)), pending_(std::move(head)), last_row_(shape.row_bytes) {}

    Result<void> put(int, const std::byte* rows, int count) override {
        while (count > 0) {
            if (!open_) begin_block();
            const int taken = open_->add(rows, count);
            rows += shape_.row_bytes * static_cast<std::size_t>(taken);
            count -= taken;
            if (!open_->is_full()) continue;
            std::memcpy(last_row_.data(), rows - shape_.row_bytes, shape_.row_bytes);
            next_ = open_->next();
            full_.push_back(std::exchange(open_, nullptr));
        }
        return {};
    }
    [[nodiscard]] bool has_work() const override { return true; }
    std::shared_ptr<RowWork> take_work() override {
        if (full_.empty()) return nullptr;
        std::shared_ptr<PngBlock> block = std::move(full_.front());
        full_.pop_front();
        return block;
    }
    Result<void> end_work(const std::shared_ptr<RowWork>& work) override {
        const auto ended = std::static_pointer_cast<PngBlock>(work);
        packed_[ended->first()] = ended;
        while (!packed_.empty() && packed_.begin()->first == written_) {
            const std::shared_ptr<PngBlock> block = std::move(packed_.extract(packed_.begin()).mapped());
            block->append_to(pending_, adler_);
            written_ = block->next();
            if (block->is_last()) end_png_chunk(pending_, begin_png_chunk(pending_, "IEND"));
            if (Result<void> written = hand_on(); !written) return written;
        }
        return {};
    }
    Result<void> finish() override {
        if (written_ == shape_.height) return {};
        return Error{ErrorCode::unsupported, {}, "rows are missing: this is a bug"};
    }

private:
    void begin_block() {
        open_ = blocks_.take([this] { return std::make_unique<PngBlock>(shape_, deflaters_); });
        open_->begin(next_, next_ > 0 ? last_row_.data() : nullptr);
    }
    Result<void> hand_on() {
        Result<void> written = write_(at_, pending_);
        at_ += pending_.size();
        pending_.clear();
        return written;
    }

    const PngShape shape_;
    const WriteBytes write_;
    Pool<PngDeflater> deflaters_;
    Pool<PngBlock> blocks_;
    std::vector<std::byte> pending_;   // what is ready to be written
    std::vector<std::byte> last_row_;  // of the last full block
    std::shared_ptr<PngBlock> open_;   // takes rows
    int next_ = 0;                     // the first row of the next block
    std::deque<std::shared_ptr<PngBlock>> full_;
    std::map<int, std::shared_ptr<PngBlock>> packed_;  // by first row
    int written_ = 0;                                  // rows
    std::uint32_t adler_ = 1;                          // of these rows
    std::uint64_t at_ = 0;
};

}  // namespace

Result<std::unique_ptr<RowTarget>> open_png_target(const TextureHead& head, WriteBytes write) {
    return no_throw([&]() -> Result<std::unique_ptr<RowTarget>> {
        const FormatInfo format = format_info(head.format);
        const int color_type = png_color_type(format);
        if (color_type < 0) {
            return Error{ErrorCode::unsupported,
                         {},
                         "PNG holds 8 or 16 bits in one, three or four channels, not " +
                             std::string(name_of(kFormatNames, head.format))};
        }
        PngWriter writer;
        if (!begin_file(writer, head.extent, color_type, format.bits, nullptr, normal_mark(head)))
            return writer.error();
        const PngShape shape{static_cast<std::size_t>(head.extent.width) * format.block_bytes, format.block_bytes,
                             head.extent.height, format.bits == 16};
        return std::unique_ptr<RowTarget>(
            std::make_unique<PngTarget>(shape, std::move(writer.bytes), std::move(write)));
    });
}

Result<std::vector<std::byte>> encode_png(const Texture& texture) {
    return no_throw([&] { return encode_rows(open_png_target, texture, false); });
}

Result<std::vector<std::byte>> encode_indexed_png(const Level& indices, const std::vector<PngColor>& palette) {
    return no_throw([&]() -> Result<std::vector<std::byte>> {
        std::vector<png_color> colors;
        colors.reserve(palette.size());
        for (const PngColor& color : palette) colors.push_back({color.r, color.g, color.b});
        PngWriter writer;
        const Extent extent = indices.extent;
        if (!begin_file(writer, extent, PNG_COLOR_TYPE_PALETTE, 8, &colors, {}) ||
            !put_rows(writer, indices.bytes.data(), extent.height, static_cast<std::size_t>(extent.width)) ||
            !end_rows(writer)) {
            return writer.error();
        }
        return std::move(writer.bytes);
    });
}

}  // namespace tex::inline v1
