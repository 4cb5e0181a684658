// SPDX-License-Identifier: Apache-2.0
// codecs.h: the table of file types, one row each.
//
// A new file type is a folder beside this file, a row in codecs.cpp, and an enumerator with its name and extensions in
// container.h. No other code depends on which type a file has.

#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string_view>

#include <tex/container.h>

#include "files/input_file.h"
#include "formats/file_layout.h"
#include "formats/row_source.h"
#include "formats/row_target.h"
#include "formats/stored_texture.h"
#include "formats/texture_rows.h"

namespace tex {

struct Codec {
    Container container;
    std::string_view magic =
        {};  // the first bytes of every such file; empty: the reader process recognises and decodes it

    // What it holds.
    bool (*holds)(const FormatInfo& format);
    bool has_levels = false;
    Encoding default_encoding = Encoding::rgb8;

    // Reading: a file in which the texels of all levels lie uncompressed has `parse`, others have `open_rows`, and
    // `open_levels` if there may be smaller levels.
    ParseTexture parse = nullptr;
    Result<std::unique_ptr<RowSource>> (*open_rows)(InputFile& file, const ReadOptions& options) = nullptr;
    Result<TextureRows> (*open_levels)(InputFile& file, const ReadOptions& options) = nullptr;
    bool decodes_twice = false;  // decoding a file twice costs less than keeping its rows

    // Writing: a file that knows the place of every byte before the first texel has `layout`, and takes strips in any
    // order; one that takes rows in their order has `open_target`; one that is encoded as a whole by the reader
    // process has the name that OpenImageIO knows it by.
    FileLayout (*layout)(const TextureHead& head, const WriteOptions& options) = nullptr;
    OpenTarget open_target = nullptr;
    const char* reader_name = nullptr;
};

[[nodiscard]] const Codec& codec_of(Container container);

// Errors: unsupported (the file type does not hold the format).
[[nodiscard]] Result<void> check_holds(const Codec& codec, Format format);

// The codec that reads a file which begins with `head`: by its magic, else the reader's.
[[nodiscard]] const Codec& codec_for(std::span<const std::byte> head);

}  // namespace tex
