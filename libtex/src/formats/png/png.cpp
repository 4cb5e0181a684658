// SPDX-License-Identifier: Apache-2.0

#include "formats/png/png.h"

#include <png.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "formats/png/png_libpng.h"
#include "formats/png/png_rows.h"
#include "formats/size_limits.h"
#include "threads/no_throw.h"

namespace tex::inline v1 {
namespace {

// Converts rows of bytes to rows [first, end) of `image`.
void store_rows8(const std::uint8_t* rows, int first, int end, Image& image) {
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
            const std::uint8_t* p = rows + c;
            for (std::size_t i = 0; i < width; ++i, p += channels) to[i] = kValues[*p];
        }
    }
}

void store_rows16(const std::uint8_t* rows, int first, int end, Image& image) {
    const std::size_t channels = image.planes.size();
    const auto width = static_cast<std::size_t>(image.extent().width);
    for (int j = first; j < end; ++j, rows += 2 * channels * width) {
        for (std::size_t c = 0; c < channels; ++c) {
            float* to = image.planes[c].row(j);
            const std::uint8_t* p = rows + 2 * c;
            for (std::size_t i = 0; i < width; ++i, p += 2 * channels) {
                to[i] = static_cast<float>(p[0] << 8 | p[1]) / 65535.0f;
            }
        }
    }
}

// Rows come from PlainPngRows as long as the file is plain. Then libpng reads it again from the start, and decides.
class PngRows final : public RowSource {
public:
    PngRows(InputFile& file, bool only_libpng) : file_(file), only_libpng_(only_libpng) {}

    // Reads the header; decode() can then read the rows.
    Result<void> open(const ReadOptions& options);

    [[nodiscard]] bool can_peek() const override { return is_interlaced_; }
    Result<void> decode(int first, int count, std::byte* rows) override;
    Result<void> finish() override;
    void store(const std::byte* rows, int first, int end, Image& image) const override {
        const auto* bytes = reinterpret_cast<const std::uint8_t*>(rows);
        is_wide_ ? store_rows16(bytes, first, end, image) : store_rows8(bytes, first, end, image);
    }

private:
    Result<void> ask_libpng(int next);
    Result<void> decode_all();

    InputFile& file_;
    const bool only_libpng_;
    ReadOptions options_;
    bool is_interlaced_ = false;
    bool is_wide_ = false;                  // 16 bits
    std::unique_ptr<LibpngReader> libpng_;  // has read the header, or reads the rows if plain_ is null
    std::unique_ptr<PlainPngRows> plain_;   // takes its bytes from the input of libpng_
    std::vector<std::byte> all_;            // all rows of an interlaced picture
};

Result<void> PngRows::open(const ReadOptions& options) {
    options_ = options;
    libpng_ = std::make_unique<LibpngReader>(file_);
    if (Result<void> opened = libpng_->open(options); !opened) return opened;
    const PngKind& kind = libpng_->kind();
    const int channels = kind.expanded_channels(), bits = kind.expanded_bits();
    const Extent extent = libpng_->extent();
    is_interlaced_ = libpng_->is_interlaced();
    is_wide_ = bits == 16;
    describe(extent, channel_names(channels),
             static_cast<std::size_t>(extent.width) * static_cast<std::size_t>(channels * bits / 8), SampleKind::unorm,
             kind.is_palette ? 8 : kind.bit_depth);
    describe_mark(libpng_->normal_mark());
    describe_orientation(libpng_->orientation(), libpng_->orientation() == 1);
    if (is_interlaced_ || only_libpng_) return libpng_->start();
    plain_ = std::make_unique<PlainPngRows>(libpng_->input(), libpng_->first_length(), extent, kind);
    return {};
}

// Starts again with libpng, up to row `next`.
Result<void> PngRows::ask_libpng(int next) {
    plain_.reset();
    libpng_.reset();
    if (Result<void> back = file_.rewind(); !back) return back;
    libpng_ = std::make_unique<LibpngReader>(file_);
    Result<void> read = libpng_->open(options_);
    if (read) read = libpng_->start();
    std::vector<std::byte> row(row_bytes());
    for (int j = 0; read && j < next; ++j) read = libpng_->decode(1, row_bytes(), row.data());
    return read;
}

Result<void> PngRows::decode(int first, int count, std::byte* rows) {
    if (plain_) {
        const Result<bool> plain = plain_->decode(count, row_bytes(), reinterpret_cast<std::uint8_t*>(rows));
        if (!plain) return plain.error();
        if (*plain) return {};
        if (Result<void> again = ask_libpng(first); !again) return again;
    }
    if (!is_interlaced_) return libpng_->decode(count, row_bytes(), rows);
    if (all_.empty()) {
        if (Result<void> decoded = decode_all(); !decoded) return decoded;
    }
    std::memcpy(rows, all_.data() + row_bytes() * static_cast<std::size_t>(first),
                row_bytes() * static_cast<std::size_t>(count));
    return {};
}

Result<void> PngRows::decode_all() {
    std::vector<std::byte> all(row_bytes() * static_cast<std::size_t>(extent().height));
    for (int pass = 0; pass < libpng_->passes(); ++pass) {
        if (Result<void> decoded = libpng_->decode(extent().height, row_bytes(), all.data()); !decoded) return decoded;
    }
    all_ = std::move(all);
    return {};
}

Result<void> PngRows::finish() {
    if (plain_) {
        const Result<bool> plain = plain_->finish();
        if (!plain) return plain.error();
        if (*plain) return {};
        if (Result<void> again = ask_libpng(extent().height); !again) return again;
    }
    return libpng_->finish();
}

// Xcode writes the chunk CgBI before the header, and compressed data without the header of zlib.
bool is_made_for_iphones(const InputFile& file) {
    constexpr std::size_t kFirstType = 12;
    constexpr std::string_view kType = "CgBI";
    const std::span<const std::byte> head = file.head();
    return head.size() >= kFirstType + kType.size() &&
           std::memcmp(head.data() + kFirstType, kType.data(), kType.size()) == 0;
}

Result<std::unique_ptr<RowSource>> open_decoder(InputFile& file, const ReadOptions& options, bool only_libpng) {
    return no_throw([&]() -> Result<std::unique_ptr<RowSource>> {
        if (is_made_for_iphones(file))
            return Error{ErrorCode::unsupported, file.path(),
                         "a PNG that Xcode changed for iPhones (CgBI); \"xcrun pngcrush -revert-iphone-optimizations\" "
                         "or pngdefry converts it"};
        auto rows = std::make_unique<PngRows>(file, only_libpng);
        if (const Result<void> opened = rows->open(options); !opened) return opened.error();
        return std::unique_ptr<RowSource>(std::move(rows));
    });
}

}  // namespace

const char* png_version() { return png_get_libpng_ver(nullptr); }

Result<std::unique_ptr<RowSource>> open_png(InputFile& file, const ReadOptions& options) {
    return open_decoder(file, options, false);
}

Result<std::unique_ptr<RowSource>> open_png_with_libpng(InputFile& file, const ReadOptions& options) {
    return open_decoder(file, options, true);
}

}  // namespace tex::inline v1
