// SPDX-License-Identifier: Apache-2.0
// file_types.h: the table of file types, one row for each type.
//
// A new file type needs a folder beside this file and a row in file_types.cpp; if it is written, too, an enumerator
// with its name and extensions in file.h. No other code depends on the type of a file.

#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string_view>

#include <tex/file.h>

#include "files/input_file.h"
#include "formats/file_layout.h"
#include "formats/row_source.h"
#include "formats/row_target.h"
#include "formats/stored_texture.h"
#include "formats/texture_rows.h"

namespace tex::inline v1 {

struct FileType {
    std::optional<Container> container = {};  // none: such files are only read
    std::string_view magic =
        {};  // the first bytes of every such file; empty: the reader process recognises and decodes it
    bool (*claims)(std::span<const std::byte> head) = nullptr;  // of a type without a magic that libtex decodes
    // Recognises a type that no bytes show, by the options or the file's name.
    bool (*is_named)(const InputFile& file, const ReadOptions& options) = nullptr;

    // What the file type can hold.
    bool (*holds)(Format format) = nullptr;
    bool has_levels = false;
    Encoding default_encoding = Encoding::rgb8;

    // Reading. File types that store the texels of all levels uncompressed set `parse`. The others set `open_rows`, and
    // `open_levels` if there may be smaller levels.
    ParseTexture parse = nullptr;
    Result<std::unique_ptr<RowSource>> (*open_rows)(InputFile& file, const ReadOptions& options) = nullptr;
    Result<TextureRows> (*open_levels)(InputFile& file, const ReadOptions& options) = nullptr;
    bool has_layers = false;  // ReadOptions::layer chooses one

    // Writing. A file type sets `layout` if the place of every byte is known before the first texel; it then takes
    // strips in any order. It sets `open_target` if it takes rows in their order. If the reader process encodes the
    // file as a whole, `reader_name` is its name for the type (reader_rows.cpp).
    FileLayout (*layout)(const TextureHead& head, const WriteOptions& options) = nullptr;
    Result<std::uint64_t> (*compress)(const FileLayout& layout, int level, const FetchBytes& fetch,
                                      const WriteBytes& write) = nullptr;  // with Zstandard, when all bytes are known
    OpenTarget open_target = nullptr;
    const char* reader_name = nullptr;
    int longest_side = kMaxExtent;  // in texels, that a file can hold
};

[[nodiscard]] const FileType& file_type_of(Container container);

// Errors: unsupported (the file type cannot hold the format, or is not compressed with Zstandard), bad_option
// (options.zstd is out of range).
[[nodiscard]] Result<void> check_holds(const FileType& type, Format format, const WriteOptions& options);

// Errors: bad_option (options.layer is set, and files of this type have no layers).
[[nodiscard]] Result<void> check_layer(const FileType& type, const ReadOptions& options);

// The type that reads a file beginning with `head`: the one with this magic or that claims it, otherwise the reader's.
[[nodiscard]] const FileType& file_type_for(std::span<const std::byte> head);
// The type of an open file, which may have no magic: the options or its name then say what it is.
[[nodiscard]] const FileType& file_type_for(const InputFile& file, const ReadOptions& options);

}  // namespace tex::inline v1
