// SPDX-License-Identifier: Apache-2.0
// tile_reader.h: reads rows of heights of one tile of a terrain, from the top.

#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <tex/pipeline.h>

#include "files/input_file.h"
#include "stream/open_heights.h"

namespace tex::inline v1 {

class TileReader {
public:
    // Opens the file at `path`. `options` must outlive the reader. May throw std::bad_alloc. Errors: those of
    // bake_file() that concern a picture and its options; they name the file.
    static Result<std::unique_ptr<TileReader>> open(const std::string& path, const BakeFileOptions& options);
    // Reads a file that is open, which must outlive the reader.
    static Result<std::unique_ptr<TileReader>> open(InputFile& file, const BakeFileOptions& options);

    [[nodiscard]] Extent extent() const { return heights_.rows->extent(); }
    [[nodiscard]] const std::string& path() const { return file_->path(); }
    [[nodiscard]] const Heights& heights() const { return heights_; }

    // Reads the heights of row j, cleaned as take_heights() does. Rows must be read from top to bottom; rows between
    // them may be left out. Returns what was found in it. May throw std::bad_alloc. Errors: those of reading, which
    // name the file.
    Result<HeightCounts> read(int j, float* out);

    // Reads what is left, and checks that the file ends as it should.
    Result<void> finish();

private:
    TileReader() = default;
    // Decodes the rows up to the unit that holds row j.
    Result<void> decode_up_to(int j);

    std::optional<InputFile> own_;
    InputFile* file_ = nullptr;
    Heights heights_;
    Plane<float> row_;  // with room for whole vectors, unlike the caller's
    std::vector<std::byte> decoded_;
    Image image_;  // the rows from first_ on
    int first_ = 0;
    int next_ = 0;            // the row after those that were decoded
    bool is_stored_ = false;  // decoded_ has become image_
};

}  // namespace tex::inline v1
