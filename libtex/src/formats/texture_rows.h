// SPDX-License-Identifier: Apache-2.0
// texture_rows.h: textures, and pictures as textures, from open files: whole, or a few rows at a time.

#pragma once

#include <cstddef>
#include <memory>
#include <numeric>
#include <vector>

#include <tex/image_io.h>
#include <tex/result.h>
#include <tex/texture.h>

#include "files/input_file.h"
#include "formats/row_source.h"

namespace tex {

// As read_texture(path), of an open file. Errors name the file.
Result<Texture> read_texture(InputFile& file, const ReadOptions& options);

// A texture whose levels come as rows.
struct TextureRows {
    Texture head;                                    // what read_texture() says of it, but for the levels
    std::vector<std::unique_ptr<RowSource>> levels;  // [0] is the base level
    std::vector<std::size_t>
        planes;           // of the images that the rows are stored in: those that hold the channels of head.format
    bool rounds = false;  // values are to go through round_to_texels() (picture.h)

    // The planes are those of the channels, in the order of the channels.
    void take_planes_in_order() {
        planes.resize(levels.front()->names().size());
        std::iota(planes.begin(), planes.end(), std::size_t{0});
    }
};

// The whole texture, once it is open. Precondition: no `rounds`. Errors: that of opening; as RowSource::read_all().
Result<Texture> read_all(Result<TextureRows> rows);

// The texture in `file`, which must outlive it. Errors: those of read_texture() that a header tells.
Result<TextureRows> open_texture_rows(InputFile& file, const ReadOptions& options);

}  // namespace tex
