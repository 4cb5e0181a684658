// SPDX-License-Identifier: Apache-2.0
// raw.h: heights without a header, as terrain tools exchange them (.raw, .r16, .r32): one channel, rows from the top,
// nothing else. No byte says what they are, so the caller does (ReadOptions::raw), or the name of the file.

#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include <tex/file.h>
#include <tex/types.h>

#include "files/input_file.h"
#include "formats/file_layout.h"
#include "formats/row_source.h"

namespace tex::inline v1 {

enum class RawType { u8, u16le, u16be, s16le, s16be, f32le, f32be };

inline constexpr Named<RawType> kRawTypeNames[] = {
    {RawType::u8, "u8", ""},       {RawType::u16le, "u16le", ""}, {RawType::u16be, "u16be", ""},
    {RawType::s16le, "s16le", ""}, {RawType::s16be, "s16be", ""}, {RawType::f32le, "f32le", ""},
    {RawType::f32be, "f32be", ""},
};

struct RawLayout {
    Extent extent;  // 0 x 0: a square that fills the file
    RawType type = RawType::u16le;
    std::int64_t skip = 0;  // bytes before the first texel
};

// Reads ReadOptions::raw. Errors: bad_option.
Result<RawLayout> parse_raw(const std::string& layout);

// Whether a file is read as raw heights: the options or its name say so.
bool is_raw(const InputFile& file, const ReadOptions& options);

// Opens a file for which is_raw() is true; it must outlive the rows. Several threads may decode at once. Errors:
// bad_option (the layout), bad_data (the file has another length), unsupported (too large), io, out_of_memory.
Result<std::unique_ptr<RowSource>> open_raw(InputFile& file, const ReadOptions& options);

// A file of one level that is nothing but its texels.
FileLayout raw_layout(const TextureHead& head, const WriteOptions& options);

}  // namespace tex::inline v1
