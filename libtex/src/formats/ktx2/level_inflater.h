// SPDX-License-Identifier: Apache-2.0
// level_inflater.h: reads compressed levels of KTX2 files: Zstandard (RFC 8878), ZLIB (RFC 1950) and BasisLZ.

#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include <tex/types.h>

#include "formats/stored_texture.h"

namespace tex::inline v1 {

// The bytes of one level of a compressed file. Zstandard is decoded as a stream, so that only its window is in memory;
// of BasisLZ, the compressed slices and a row of blocks are; ZLIB is decoded as a whole. A level that holds too few or
// too many bytes is an error, and nothing is allocated for bytes beyond its extent.
class LevelInflater {
public:
    // `texture` is that of the level, and is compressed. Throws std::bad_alloc.
    static std::unique_ptr<LevelInflater> make(const StoredTexture& texture, FetchBytes fetch,
                                               const StoredTexture::Level& place);
    LevelInflater(const LevelInflater&) = delete;
    LevelInflater& operator=(const LevelInflater&) = delete;
    virtual ~LevelInflater() = default;

    // Decodes bytes at `offset` of the level. Each smaller offset than before starts again from the first byte. Throws
    // std::bad_alloc. Errors: bad_data; unsupported (a dictionary, a window above 128 MiB); those of `fetch`. Those of
    // this class do not name the file.
    Result<void> read(std::uint64_t offset, std::span<std::byte> bytes);

protected:
    LevelInflater(FetchBytes fetch, const StoredTexture::Level& place, std::uint64_t decoded)
        : fetch_(std::move(fetch)), place_(place), decoded_(decoded) {}

    // Goes back to the first byte.
    virtual void restart() = 0;
    // Decodes the next bytes.
    virtual Result<void> next(std::span<std::byte> bytes) = 0;
    // Checks that nothing is left after the last byte.
    virtual Result<void> end() = 0;

    // Compressed bytes.
    [[nodiscard]] Result<std::vector<std::byte>> fetch(std::uint64_t offset, std::size_t count) const {
        return fetch_(place_.offset + offset, count);
    }
    [[nodiscard]] std::uint64_t stored() const { return place_.bytes; }
    [[nodiscard]] std::uint64_t decoded() const { return decoded_; }

private:
    const FetchBytes fetch_;
    const StoredTexture::Level place_;
    const std::uint64_t decoded_;
    std::uint64_t position_ = 0;  // of the next byte
};

// The most bytes that a byte of compressed data can stand for.
[[nodiscard]] double most_inflation(Supercompression scheme);

}  // namespace tex::inline v1
