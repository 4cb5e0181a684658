// SPDX-License-Identifier: Apache-2.0
// stored_texture.h: where the texels of a DDS, KTX or KTX2 file are, according to its header, and how they are
// converted to a Format.

#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <tex/file.h>
#include <tex/format.h>
#include <tex/types.h>

#include "formats/dds/fields.h"

namespace tex::inline v1 {

// Reads bytes of a file. Precondition: the file has them. Errors: io.
using FetchBytes = std::function<Result<std::vector<std::byte>>(std::uint64_t offset, std::size_t count)>;

// How KTX2 compresses the bytes of each level.
enum class Supercompression { none, zstd, zlib, basis_lz };

struct BasisCodebooks;

struct StoredTexture {
    struct Level {
        Extent extent;
        std::uint64_t offset = 0;
        std::uint64_t bytes = 0;  // in the file
        // A compressed level's bytes with all layers, and those before the layer that is read.
        std::uint64_t inflated = 0;
        std::uint64_t skipped = 0;
        // BasisLZ: the slice of alpha, if there is one; `offset` and `bytes` are those of the colours.
        std::uint64_t alpha_offset = 0;
        std::uint64_t alpha_bytes = 0;
    };
    Texture head;                       // without levels
    std::vector<Level> levels;          // all of their bytes are within the file
    std::optional<FieldLayout> fields;  // of the file's texels; none: they are in head.format,
    bool bgr = false;                   // except that red and blue may be exchanged
    bool upwards = false;               // the bottom row comes first; never with blocks
    Supercompression supercompression = Supercompression::none;
    std::shared_ptr<const BasisCodebooks> codebooks;  // of BasisLZ
    std::size_t row_alignment = 1;                    // rows begin at multiples of so many bytes
};

// The number of bytes that the file uses for a row of texels, or for a row of blocks, with those between the rows.
[[nodiscard]] std::size_t stored_pitch(const StoredTexture& texture, int width);

// Whether rows are in the file as in memory.
[[nodiscard]] bool is_as_in_memory(const StoredTexture& texture, int width);

// Converts `count` rows of texels or blocks from the file to rows of head.format.
void convert_rows(const StoredTexture& texture, const std::byte* source, int width, int count, std::byte* target);

// Finds the texels of a file of `size` bytes. Error messages call the file `name`. Errors: bad_data, unsupported, as
// read_texture(); those of `fetch`. May throw std::bad_alloc.
using ParseTexture = Result<StoredTexture> (*)(const FetchBytes& fetch, std::size_t size, const std::string& name,
                                               const ReadOptions& options);

// The whole texture in a file that is in memory. Errors: those of `parse`. May throw std::bad_alloc.
[[nodiscard]] Result<Texture> load_texture(ParseTexture parse, const std::byte* data, std::size_t size,
                                           const std::string& name, const ReadOptions& options);

}  // namespace tex::inline v1
