// SPDX-License-Identifier: Apache-2.0

#include "formats/ktx2/level_inflater.h"

#include <algorithm>
#include <new>
#include <string>
#include <utility>
#include <vector>

#include <libdeflate.h>
#include <zstd.h>
#include <zstd_errors.h>

#include "formats/bytes.h"
#include "formats/ktx2/basis_inflater.h"
#include "formats/ktx2/compress_ktx2.h"
#include "formats/size_limits.h"

namespace tex::inline v1 {
namespace {

Error damaged(std::string reason) { return {ErrorCode::bad_data, {}, "compressed level: " + std::move(reason)}; }

// -- reading Zstandard -----------------------------------------------------------------------------------------

struct FreeDecompressor {
    void operator()(ZSTD_DStream* stream) const { ZSTD_freeDStream(stream); }
};

// A level must be one frame, without a dictionary (RFC 8878, 3.1.1). A skippable frame has another magic number.
Result<void> check_frame(std::span<const std::byte> head) {
    constexpr std::uint32_t kMagic = 0xfd2fb528;
    if (head.size() < 5 || load_u32(head.data()) != kMagic) return damaged("no Zstandard frame");
    if ((std::to_integer<unsigned>(head[4]) & 3U) == 0) return {};
    return Error{ErrorCode::unsupported, {}, "Zstandard with a dictionary is not supported"};
}

class ZstdInflater final : public LevelInflater {
public:
    ZstdInflater(FetchBytes fetch, const StoredTexture::Level& place, std::uint64_t decoded)
        : LevelInflater(std::move(fetch), place, decoded), stream_(ZSTD_createDStream()) {
        if (stream_ == nullptr) throw std::bad_alloc();
    }

protected:
    void restart() override {
        ZSTD_DCtx_reset(stream_.get(), ZSTD_reset_session_only);
        fetched_ = 0;
        input_ = {};
        is_finished_ = false;
    }
    Result<void> next(std::span<std::byte> bytes) override;
    Result<void> end() override;

private:
    // Decodes until `output` is full or the data end.
    Result<void> decode(ZSTD_outBuffer& output);
    Result<void> fill();

    const std::unique_ptr<ZSTD_DStream, FreeDecompressor> stream_;
    std::vector<std::byte> waiting_;  // compressed bytes
    ZSTD_inBuffer input_ = {};        // those of them that are not decoded yet
    std::uint64_t fetched_ = 0;
    bool is_finished_ = false;  // the frame has ended
};

// Reads more compressed bytes if none is waiting.
Result<void> ZstdInflater::fill() {
    if (input_.pos < input_.size || fetched_ == stored()) return {};
    Result<std::vector<std::byte>> bytes =
        fetch(fetched_, static_cast<std::size_t>(std::min<std::uint64_t>(kChunkBytes, stored() - fetched_)));
    if (!bytes) return bytes.error();
    waiting_ = std::move(*bytes);
    if (fetched_ == 0) {
        if (Result<void> checked = check_frame(waiting_); !checked) return checked;
    }
    fetched_ += waiting_.size();
    input_ = {waiting_.data(), waiting_.size(), 0};
    return {};
}

Result<void> ZstdInflater::decode(ZSTD_outBuffer& output) {
    while (!is_finished_ && output.pos < output.size) {
        if (Result<void> filled = fill(); !filled) return filled;
        const std::size_t before = output.pos;
        const bool has_input = input_.pos < input_.size;
        const std::size_t left = ZSTD_decompressStream(stream_.get(), &output, &input_);
        if (ZSTD_isError(left) != 0) {
            if (ZSTD_getErrorCode(left) == ZSTD_error_memory_allocation) throw std::bad_alloc();
            return damaged(ZSTD_getErrorName(left));
        }
        is_finished_ = left == 0;
        if (!is_finished_ && !has_input && output.pos == before) return damaged("the data end too early");
    }
    return {};
}

Result<void> ZstdInflater::next(std::span<std::byte> bytes) {
    ZSTD_outBuffer output = {bytes.data(), bytes.size(), 0};
    if (Result<void> done = decode(output); !done) return done;
    return output.pos == output.size ? Result<void>() : damaged("holds too few bytes");
}

Result<void> ZstdInflater::end() {
    std::byte more{};
    ZSTD_outBuffer output = {&more, 1, 0};
    if (Result<void> done = decode(output); !done) return done;
    if (output.pos > 0) return damaged("holds too many bytes");
    return input_.pos == input_.size && fetched_ == stored() ? Result<void>() : damaged("data after the frame");
}

// -- reading ZLIB ----------------------------------------------------------------------------------------------

class ZlibInflater final : public LevelInflater {
public:
    ZlibInflater(FetchBytes fetch, const StoredTexture::Level& place, std::uint64_t decoded)
        : LevelInflater(std::move(fetch), place, decoded) {}

protected:
    void restart() override { position_ = 0; }
    Result<void> next(std::span<std::byte> bytes) override {
        if (level_.empty()) {
            if (Result<void> done = inflate(); !done) return done;
        }
        std::copy_n(level_.begin() + static_cast<std::ptrdiff_t>(position_), bytes.size(), bytes.begin());
        position_ += bytes.size();
        return {};
    }
    Result<void> end() override { return {}; }  // inflate() has checked it

private:
    Result<void> inflate();

    std::vector<std::byte> level_;
    std::size_t position_ = 0;
};

Result<void> ZlibInflater::inflate() {
    const std::unique_ptr<libdeflate_decompressor, void (*)(libdeflate_decompressor*)> inflater(
        libdeflate_alloc_decompressor(), libdeflate_free_decompressor);
    if (inflater == nullptr) throw std::bad_alloc();
    const Result<std::vector<std::byte>> compressed = fetch(0, static_cast<std::size_t>(stored()));
    if (!compressed) return compressed.error();
    std::vector<std::byte> level(static_cast<std::size_t>(decoded()));
    std::size_t used = 0;
    // Without a place for the size, the result must fill the buffer exactly.
    const libdeflate_result result = libdeflate_zlib_decompress_ex(
        inflater.get(), compressed->data(), compressed->size(), level.data(), level.size(), &used, nullptr);
    if (result != LIBDEFLATE_SUCCESS || used != compressed->size()) return damaged("not the ZLIB data of this level");
    level_ = std::move(level);
    return {};
}

}  // namespace

std::unique_ptr<LevelInflater> LevelInflater::make(const StoredTexture& texture, FetchBytes fetch,
                                                   const StoredTexture::Level& place) {
    switch (texture.supercompression) {
        case Supercompression::basis_lz: return make_basis_inflater(texture, std::move(fetch), place);
        case Supercompression::zlib: return std::make_unique<ZlibInflater>(std::move(fetch), place, place.inflated);
        default: return std::make_unique<ZstdInflater>(std::move(fetch), place, place.inflated);
    }
}

Result<void> LevelInflater::read(std::uint64_t offset, std::span<std::byte> bytes) {
    if (offset < position_) {
        restart();
        position_ = 0;
    }
    std::vector<std::byte> skipped(static_cast<std::size_t>(std::min<std::uint64_t>(kChunkBytes, offset - position_)));
    while (position_ < offset) {
        const std::span<std::byte> part(
            skipped.data(), static_cast<std::size_t>(std::min<std::uint64_t>(skipped.size(), offset - position_)));
        if (Result<void> done = next(part); !done) return done;
        position_ += part.size();
    }
    if (Result<void> done = next(bytes); !done) return done;
    position_ += bytes.size();
    return position_ == decoded_ ? end() : Result<void>();
}

double most_inflation(Supercompression scheme) {
    // A block of Zstandard that repeats one byte 128 KiB times takes 4 bytes (RFC 8878, 3.1.1.2.2).
    return scheme == Supercompression::zlib ? kDeflateRatio : 32768.0;
}

}  // namespace tex::inline v1
