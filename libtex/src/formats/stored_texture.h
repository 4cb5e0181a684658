// SPDX-License-Identifier: Apache-2.0
// stored_texture.h: where the texels of a DDS or KTX2 file stand, as its header tells, and how they become those of a
// Format.

#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include <tex/result.h>
#include <tex/texture.h>

#include "formats/dds/fields.h"

namespace tex {

// Some bytes of a file. Precondition: the file has them. Errors: io.
using FetchBytes = std::function<Result<std::vector<std::byte>>(std::uint64_t offset, std::size_t count)>;

// Those of a file in memory, which must outlive the function.
FetchBytes fetch_from(const std::byte* data);

struct StoredTexture {
    struct Place {
        Extent extent;
        std::uint64_t offset = 0;
    };
    Texture head;                       // without levels
    std::vector<Place> levels;          // all of their bytes are in the file
    std::optional<FieldLayout> fields;  // of the file's texels; else they are in head.format,
    bool bgr = false;                   // but for red and blue, which have changed places
    bool upwards = false;               // the bottom row comes first; never with blocks
};

// Bytes in the file of a row of texels, or of a row of blocks.
[[nodiscard]] std::size_t stored_pitch(const StoredTexture& texture, int width);

// `count` rows of the file, of texels or of blocks, become such rows of head.format.
void convert_rows(const StoredTexture& texture, const std::byte* source, int width, int count, std::byte* target);

// The whole texture, from all bytes of the file. May throw std::bad_alloc.
[[nodiscard]] Texture load_texture(const StoredTexture& texture, const std::byte* data);

}  // namespace tex
