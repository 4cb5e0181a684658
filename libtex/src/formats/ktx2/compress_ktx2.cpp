// SPDX-License-Identifier: Apache-2.0

#include "formats/ktx2/compress_ktx2.h"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <new>
#include <vector>

#include <zstd.h>

#include "formats/bytes.h"

namespace tex::inline v1 {
namespace {

struct FreeCompressor {
    void operator()(ZSTD_CCtx* context) const { ZSTD_freeCCtx(context); }
};

// Compresses one level into the file, from `offset` on.
class LevelCompressor {
public:
    LevelCompressor(int level, const FetchBytes& fetch, const WriteBytes& write)
        : context_(ZSTD_createCCtx()), fetch_(fetch), write_(write), packed_(kChunkBytes) {
        if (context_ == nullptr) throw std::bad_alloc();
        ZSTD_CCtx_setParameter(context_.get(), ZSTD_c_compressionLevel, level);
    }

    // Returns the number of bytes written.
    Result<std::uint64_t> compress(const FileLayout::Level& place, std::uint64_t offset) {
        ZSTD_CCtx_reset(context_.get(), ZSTD_reset_session_only);
        ZSTD_CCtx_setPledgedSrcSize(context_.get(), place.bytes);
        std::uint64_t written = 0;
        for (std::uint64_t done = 0; done < place.bytes;) {
            const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(kChunkBytes, place.bytes - done));
            const Result<std::vector<std::byte>> plain = fetch_(place.offset + done, count);
            if (!plain) return plain.error();
            done += count;
            const Result<std::uint64_t> put = pass(*plain, done == place.bytes, offset + written);
            if (!put) return put.error();
            written += *put;
        }
        return written;
    }

private:
    Result<std::uint64_t> pass(const std::vector<std::byte>& plain, bool is_last, std::uint64_t offset) {
        ZSTD_inBuffer input = {plain.data(), plain.size(), 0};
        std::uint64_t written = 0;
        while (true) {
            ZSTD_outBuffer output = {packed_.data(), packed_.size(), 0};
            const std::size_t left =
                ZSTD_compressStream2(context_.get(), &output, &input, is_last ? ZSTD_e_end : ZSTD_e_continue);
            if (ZSTD_isError(left) != 0) return Error{ErrorCode::out_of_memory, {}, ZSTD_getErrorName(left)};
            if (output.pos > 0) {
                if (const Result<void> put = write_(offset + written, {packed_.data(), output.pos}); !put)
                    return put.error();
            }
            written += output.pos;
            if (is_last ? left == 0 : input.pos == input.size) return written;
        }
    }

    const std::unique_ptr<ZSTD_CCtx, FreeCompressor> context_;
    const FetchBytes& fetch_;
    const WriteBytes& write_;
    std::vector<std::byte> packed_;
};

void store(std::vector<std::byte>& bytes, std::size_t offset, std::uint64_t value, std::size_t count) {
    for (std::size_t k = 0; k < count; ++k) bytes[offset + k] = static_cast<std::byte>(value >> (8 * k) & 0xff);
}

}  // namespace

Result<std::uint64_t> compress_ktx2(const FileLayout& layout, int level, const FetchBytes& fetch,
                                    const WriteBytes& write) {
    // Fields of the header, of an entry of the level index, and of the descriptor (KTX 2.0, 3 and 5.2).
    constexpr std::size_t kScheme = 44, kDescriptor = 48, kIndex = 80, kEntry = 24, kBytesPlane0 = 20;
    LevelCompressor compressor(level, fetch, write);
    std::vector<std::byte> head = layout.head;
    std::uint64_t size = head.size();
    for (std::size_t k = layout.levels.size(); k-- > 0;) {
        const Result<std::uint64_t> written = compressor.compress(layout.levels[k], size);
        if (!written) return written.error();
        store(head, kIndex + k * kEntry, size, 8);
        store(head, kIndex + k * kEntry + 8, *written, 8);
        size += *written;
    }
    store(head, kScheme, 2, 4);
    store(head, load_u32(head.data() + kDescriptor) + kBytesPlane0, 0, 1);  // compressed levels have no size per block
    if (const Result<void> put = write(0, head); !put) return put.error();
    return size;
}

Result<std::uint64_t> compressed_size(const FileLayout::Level& place, int level, const FetchBytes& fetch) {
    const WriteBytes discard = [](std::uint64_t, std::span<const std::byte>) { return Result<void>(); };
    return LevelCompressor(level, fetch, discard).compress(place, 0);
}

const char* zstd_version() { return ZSTD_versionString(); }

}  // namespace tex::inline v1
