// SPDX-License-Identifier: Apache-2.0
// compress_ktx2.h: compresses KTX2 files with Zstandard (RFC 8878).

#pragma once

#include <cstddef>
#include <cstdint>

#include <tex/types.h>

#include "formats/file_layout.h"
#include "formats/row_target.h"
#include "formats/stored_texture.h"

namespace tex::inline v1 {

inline constexpr std::size_t kChunkBytes = std::size_t{1} << 18;  // that are read or written together

// Compresses the levels of a KTX2 file with Zstandard. `layout` is that of the file without compression, which `fetch`
// reads; `level` is from 1 (fast) to 22 (small). Returns the size of the compressed file. Equal files give equal bytes.
// Throws std::bad_alloc. Errors: out_of_memory; those of `fetch` and `write`.
[[nodiscard]] Result<std::uint64_t> compress_ktx2(const FileLayout& layout, int level, const FetchBytes& fetch,
                                                  const WriteBytes& write);

// The size of one level after that, without the rest of the file. Errors and exceptions: as compress_ktx2().
[[nodiscard]] Result<std::uint64_t> compressed_size(const FileLayout::Level& place, int level, const FetchBytes& fetch);

// The level at which blocks are judged that a file stores without compression: what they are compressed with later is
// not known.
inline constexpr int kJudgedZstdLevel = 19;

// The version of libzstd at run time: "1.5.4".
[[nodiscard]] const char* zstd_version();

}  // namespace tex::inline v1
