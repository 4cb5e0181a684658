// SPDX-License-Identifier: Apache-2.0
// texture_rows.h: reads textures, and pictures as textures, from open files, whole or a few rows at a time.

#pragma once

#include <cstddef>
#include <memory>
#include <numeric>
#include <vector>

#include <tex/file.h>
#include <tex/format.h>
#include <tex/types.h>

#include "files/input_file.h"
#include "formats/row_source.h"

namespace tex::inline v1 {

// Does what read_texture(path) does, for an open file. Errors name the file.
Result<Texture> read_texture(InputFile& file, const ReadOptions& options);

// A texture whose levels are read as rows.
struct TextureRows {
    Texture head;                                    // what read_texture() returns for it, except the levels
    std::vector<std::unique_ptr<RowSource>> levels;  // [0] is the base level
    std::vector<std::size_t>
        planes;           // of the images in which the rows are stored: those that hold the channels of head.format
    bool rounds = false;  // values must go through round_to_texels() (picture.h)

    // Sets `planes` if the planes are the channels, in the same order.
    void take_planes_in_order() {
        planes.resize(levels.front()->names().size());
        std::iota(planes.begin(), planes.end(), std::size_t{0});
    }
};

// Reads the whole texture if it could be opened. Errors: that of opening; as RowSource::visit().
Result<Texture> read_all(Result<TextureRows> rows);

// Opens the texture in `file`, which must outlive the rows. Errors: those of read_texture() that the header reveals.
Result<TextureRows> open_texture_rows(InputFile& file, const ReadOptions& options);

}  // namespace tex::inline v1
