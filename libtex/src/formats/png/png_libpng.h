// SPDX-License-Identifier: Apache-2.0
// png_libpng.h: PNG files read by libpng. It reads the chunks before the texels of all files, and the texels of those
// that png_rows.h does not know.

#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <tex/file.h>
#include <tex/types.h>

#include "formats/png/png_expand.h"
#include "formats/png/png_input.h"
#include "formats/png/png_state.h"

namespace tex::inline v1 {

class LibpngReader : private PngState {
public:
    // Throws std::bad_alloc. The file must outlive this object.
    explicit LibpngReader(InputFile& file) : file_(file), input_(file) {}
    ~LibpngReader() { png_destroy_read_struct(&png, &info, nullptr); }
    LibpngReader(const LibpngReader&) = delete;
    LibpngReader& operator=(const LibpngReader&) = delete;

    // Reads the chunks up to the header of the first IDAT chunk, and checks what they claim. Errors: those of
    // open_png() (png.h).
    Result<void> open(const ReadOptions& options);

    [[nodiscard]] Extent extent() const { return extent_; }
    [[nodiscard]] const PngKind& kind() const { return kind_; }
    [[nodiscard]] bool is_interlaced() const { return is_interlaced_; }
    [[nodiscard]] const std::string& normal_mark() const { return normal_mark_; }
    [[nodiscard]] int orientation() const { return orientation_; }  // 1 to 8, as eXIf says

    // The number of bytes in the first IDAT chunk, which come next in the input. From here on, either the caller reads
    // the input, or the functions below do.
    [[nodiscard]] std::uint32_t first_length() const;
    [[nodiscard]] PngInput& input() { return input_; }

    // Prepares for rows of expanded texels (png_expand.h). Errors: bad_data, out_of_memory.
    Result<void> start();
    // The number of times that all rows are read: each pass of an interlaced picture adds texels to all of its rows.
    [[nodiscard]] int passes() const { return passes_; }
    // Decodes the next rows, `row_bytes` apart. Errors: bad_data, io, out_of_memory.
    Result<void> decode(int count, std::size_t row_bytes, std::byte* rows);
    // Checks that the file ends as it should. Errors: as decode().
    Result<void> finish();

private:
    static void on_read(png_structp png, png_bytep data, std::size_t count);
    bool read_header();
    bool start_rows();
    bool decode_rows(int count, std::size_t row_bytes, png_byte* rows);
    bool decode_end();
    void describe();
    [[nodiscard]] Error error() const;

    InputFile& file_;
    PngInput input_;
    png_byte chunk_header_[8] = {};  // the last one that was read
    std::int64_t width_ = 0, height_ = 0, file_row_bytes_ = 0;
    Extent extent_;
    PngKind kind_;
    bool is_interlaced_ = false;
    int passes_ = 1;
    std::string normal_mark_;
    int orientation_ = 1;
};

}  // namespace tex::inline v1
