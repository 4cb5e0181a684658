// SPDX-License-Identifier: Apache-2.0
// ktx2.h: KTX 2.0 files, both directions (Khronos: KTX File Format Specification, version 2.0).
//
//     identifier  header  level index  data format descriptor  key/value data  levels, the smallest first

#pragma once

#include <cstddef>
#include <string>

#include <tex/image_io.h>
#include <tex/result.h>
#include <tex/texture.h>

#include "formats/file_layout.h"
#include "formats/stored_texture.h"

namespace tex {

// True where the bytes begin as a KTX 2 file does.
[[nodiscard]] bool is_ktx2(const std::byte* data, std::size_t size);

// Three channels of 16 or 32 bits are widened. Where the swizzle is known, the key "libtex.normal" holds it: "dxt5nm"
// or the four letters of to_string(), and behind a blank "+y" or "-y" where that is known.
[[nodiscard]] FileLayout ktx2_layout(const TextureHead& head);

// Where the texels of a file of `size` bytes stand. Errors: as decode_ktx2(); those of `fetch`. May throw
// std::bad_alloc.
[[nodiscard]] Result<StoredTexture> parse_ktx2(const FetchBytes& fetch, std::size_t size, const std::string& name,
                                               const ReadOptions& options);

// Errors: bad_data, unsupported, as read_texture(). May throw std::bad_alloc.
[[nodiscard]] Result<Texture> decode_ktx2(const std::byte* data, std::size_t size, const std::string& name,
                                          const ReadOptions& options);

}  // namespace tex
