// SPDX-License-Identifier: Apache-2.0

#include "stream/tile_reader.h"

#include <algorithm>
#include <utility>

#include "formats/size_limits.h"

namespace tex::inline v1 {

Result<std::unique_ptr<TileReader>> TileReader::open(const std::string& path, const BakeFileOptions& options) {
    Result<InputFile> file = InputFile::open(path);
    if (!file) return file.error();
    std::unique_ptr<TileReader> reader(new TileReader);
    reader->own_.emplace(std::move(*file));
    Result<Heights> heights = open_height_rows(*reader->own_, options);
    if (!heights) return heights.error().of(path);
    reader->file_ = &*reader->own_;
    reader->heights_ = std::move(*heights);
    return reader;
}

Result<std::unique_ptr<TileReader>> TileReader::open(InputFile& file, const BakeFileOptions& options) {
    std::unique_ptr<TileReader> reader(new TileReader);
    Result<Heights> heights = open_height_rows(file, options);
    if (!heights) return heights.error();
    reader->file_ = &file;
    reader->heights_ = std::move(*heights);
    return reader;
}

Result<void> TileReader::decode_up_to(int j) {
    RowSource& rows = *heights_.rows;
    const int together = rows.rows_together(), unit = j / together * together;
    if (decoded_.empty()) {
        const int held = rows.held_rows(together);
        decoded_.resize(rows.row_bytes() * static_cast<std::size_t>(held));
        image_ = make_image({rows.extent().width, held}, rows.names());
        row_ = Plane<float>(Extent{rows.extent().width, 1});
    }
    if (rows.is_random()) next_ = std::max(next_, unit);
    while (next_ <= j) {
        const int count = std::min(together, rows.extent().height - next_);
        if (const Result<void> done = rows.decode(next_, count, decoded_.data()); !done)
            return done.error().of(file_->path());
        first_ = next_;
        next_ += count;
        is_stored_ = false;
    }
    return {};
}

Result<HeightCounts> TileReader::read(int j, float* out) {
    if (Result<void> done = decode_up_to(j); !done) return done.error();
    if (!is_stored_) {
        const int count = next_ - first_;
        heights_.rows->store(decoded_.data(), 0, count, image_);
        if (heights_.linear) {
            if (const Result<void> linear = heights_.linear->convert(image_, count); !linear)
                return linear.error().of(file_->path());
        }
        is_stored_ = true;
    }
    const HeightCounts found = take_heights(image_, heights_.source, heights_.options, j - first_, row_.row(0));
    std::copy_n(row_.row(0), extent().width, out);
    return found;
}

Result<void> TileReader::finish() {
    if (Result<void> done = decode_up_to(extent().height - 1); !done) return done;
    const Result<void> ended = heights_.rows->finish();
    return ended ? ended : Result<void>(ended.error().of(file_->path()));
}

}  // namespace tex::inline v1
