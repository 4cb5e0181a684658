// SPDX-License-Identifier: Apache-2.0

#include "formats/png/png_block.h"

#include <libdeflate.h>
#include <zlib.h>

#include <algorithm>
#include <cstring>
#include <new>

#include "formats/png/png_chunk.h"
#include "kernels/png_filter.h"

namespace tex::inline v1 {
namespace {

// After an adaptive filter, a normal map has hardly any repetition that deflate could find. Run lengths alone therefore
// give the same size as zlib's level 6, two to five times as fast (measured on baked and on painted maps, 8 and 16
// bits).
constexpr int kStrategy = Z_RLE;

// Large enough that the ends of blocks cost nothing (two parts in ten thousand), small enough for a few of them to stay
// in a cache.
constexpr std::size_t kBlockBytes = std::size_t{128} << 10;

// Runs end with a block and refer to the byte before: the window of zlib matters only for its speed.
constexpr int kWindowBits = 15;
constexpr int kMemoryLevel = 8;

constexpr std::uint32_t kZlibHeader = 0x7801;  // a window of 32 KB, the fastest compression

constexpr std::size_t kBefore = 64;  // zeros before a row: at least a texel, and rows stay aligned

}  // namespace

int PngShape::rows_of_block() const { return static_cast<int>(std::max<std::size_t>(1, kBlockBytes / row_bytes)); }

PngDeflater::PngDeflater() : stream_(std::make_unique<z_stream>()) {
    // Without a header and a check value.
    if (deflateInit2(stream_.get(), Z_DEFAULT_COMPRESSION, Z_DEFLATED, -kWindowBits, kMemoryLevel, kStrategy) != Z_OK)
        throw std::bad_alloc();
}

PngDeflater::~PngDeflater() { deflateEnd(stream_.get()); }

std::size_t PngDeflater::bound(std::size_t count) const {
    constexpr std::size_t kFlush = 16;  // the mark at the end of a block: at most 6 bytes
    return deflateBound(stream_.get(), count) + kFlush;
}

void PngDeflater::begin(std::uint8_t* out, std::size_t room) {
    deflateReset(stream_.get());
    stream_->next_out = out;
    stream_->avail_out = static_cast<uInt>(room);
}

bool PngDeflater::put(const std::uint8_t* bytes, std::size_t count) {
    stream_->next_in = const_cast<Bytef*>(bytes);
    stream_->avail_in = static_cast<uInt>(count);
    return deflate(stream_.get(), Z_NO_FLUSH) == Z_OK && stream_->avail_in == 0;
}

// If the room ended within the flush, zlib would repeat its mark.
std::size_t PngDeflater::end(bool is_last) {
    const int state = deflate(stream_.get(), is_last ? Z_FINISH : Z_SYNC_FLUSH);
    const bool ended = state == (is_last ? Z_STREAM_END : Z_OK) && stream_->avail_out > 0;
    return ended ? stream_->total_out : 0;
}

PngBlock::PngBlock(const PngShape& shape, Pool<PngDeflater>& deflaters)
    : shape_(shape), stride_((shape.row_bytes + 2 * kBefore - 1) / kBefore * kBefore), deflaters_(deflaters),
      held_rows_(static_cast<std::size_t>(std::min(shape.rows_of_block(), shape.height) + 2) * stride_) {}

void PngBlock::begin(int first, const std::byte* before) {
    first_ = first;
    rows_ = std::min(shape_.rows_of_block(), shape_.height - first);
    held_ = 0;
    if (before != nullptr)
        std::memcpy(row(-1), before, shape_.row_bytes);
    else
        std::fill_n(row(-1), shape_.row_bytes, std::uint8_t{0});
}

int PngBlock::add(const std::byte* rows, int count) {
    const int taken = std::min(count, rows_ - held_);
    for (int j = 0; j < taken; ++j, rows += shape_.row_bytes) std::memcpy(row(held_ + j), rows, shape_.row_bytes);
    held_ += taken;
    return taken;
}

Result<void> PngBlock::run() {
    const std::shared_ptr<PngDeflater> deflater = deflaters_.take([] { return std::make_unique<PngDeflater>(); });
    const std::size_t filtered = 1 + shape_.row_bytes;
    deflater->row.resize(filtered);
    std::uint8_t* const out = deflater->row.data();
    if (const std::size_t most = deflater->bound(static_cast<std::size_t>(rows_) * filtered); most > room_) {
        packed_ = std::make_unique_for_overwrite<std::uint8_t[]>(most);
        room_ = most;
    }
    deflater->begin(packed_.get(), room_);
    adler_ = 1;
    bool fits = true;
    for (int j = -1; j < rows_; ++j) {
        if (shape_.swaps) swap_sample_bytes(row(j), shape_.row_bytes / 2);
        if (j < 0) continue;
        filter_png_row(row(j), row(j - 1), shape_.row_bytes, shape_.texel_bytes, out);
        adler_ = libdeflate_adler32(adler_, out, filtered);
        fits = fits && deflater->put(out, filtered);
    }
    packed_bytes_ = deflater->end(is_last());
    if (fits && packed_bytes_ > 0) return {};
    return Error{ErrorCode::unsupported, {}, "PNG cannot be written: zlib needs more room than it says"};
}

void PngBlock::append_to(std::vector<std::byte>& file, std::uint32_t& adler) const {
    const std::size_t filtered = static_cast<std::size_t>(rows_) * (1 + shape_.row_bytes);
    adler = static_cast<std::uint32_t>(adler32_combine(adler, adler_, static_cast<z_off_t>(filtered)));
    const std::size_t begun = begin_png_chunk(file, "IDAT");
    if (first_ == 0) put_png_number(file, kZlibHeader, 2);
    const auto* from = reinterpret_cast<const std::byte*>(packed_.get());
    file.insert(file.end(), from, from + packed_bytes_);
    if (is_last()) put_png_number(file, adler, 4);
    end_png_chunk(file, begun);
}

}  // namespace tex::inline v1
