// SPDX-License-Identifier: Apache-2.0
// row_source.h: reads a picture a few rows at a time.
//
// Rows are decoded first, in order, as decoders require. Later, any thread may convert the decoded rows to floats (see
// Image). Both steps can therefore run in parallel.

#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <tex/file.h>
#include <tex/height.h>
#include <tex/types.h>

#include "blocks/extent.h"
#include "files/input_file.h"
#include "formats/stored_samples.h"
#include "rows/height_source.h"

namespace tex::inline v1 {

inline constexpr const char* kMultipliedText =
    "R, G and B are multiplied by alpha, as the file says, and are read as they are stored";

// What a picture's orientation, which is not 1, means for it, as a sentence.
std::string orientation_text(int orientation, bool is_turned);

// What Texture::trailing_bytes, which is not 0, means, as a sentence.
std::string trailing_text(std::uint64_t bytes);

// What a file says of a picture, besides its texels.
struct PictureHead : PictureFacts {
    Extent extent;
    std::size_t row_bytes = 0;         // of a decoded row
    std::string normal_encoding = {};  // this and the next two as in Image
    std::string normal_mark = {};
    std::string remark = {};
    bool is_no_data_assumed = false;        // the file does not say no_data, but files of its type usually mean it
    StoredSamples samples = {};             // of a GeoTIFF, for example, which states units
    std::optional<Strength> strength = {};  // that a file of heights states (Texture::bumpiness_x)
    int orientation = 1;                    // as in Texture
    bool is_turned = true;                  // Texture::turned
    bool is_multiplied = false;             // the file says that colours were multiplied by alpha; they still are
    std::string absent = {};                // a sentence, in `remark` too: parts of the file were never written
};

class RowSource {
public:
    RowSource() = default;
    RowSource(const RowSource&) = delete;
    RowSource& operator=(const RowSource&) = delete;
    virtual ~RowSource() = default;

    [[nodiscard]] const PictureHead& head() const { return head_; }
    [[nodiscard]] Extent extent() const { return head_.extent; }
    [[nodiscard]] const std::vector<std::string>& names() const { return head_.names; }
    [[nodiscard]] std::size_t row_bytes() const { return head_.row_bytes; }

    // The number of rows that the file stores as one unit. decode() is cheapest if `first` is a multiple of this
    // number, and `count` either is a multiple too or reaches the last row.
    [[nodiscard]] virtual int rows_together() const { return 1; }
    // Whether rows may be decoded in any order, by several threads at once. If not, rows are decoded from the top,
    // once, without gaps.
    [[nodiscard]] virtual bool is_random() const { return false; }

    // Limits reading to these planes; the contents of the other planes do not matter. Call this before rows are stored.
    virtual void choose_planes(const std::vector<bool>&) {}

    // Makes store() and PictureHead::no_data give the numbers that the file stores, exactly; false if this source
    // cannot. Call this before rows are stored.
    virtual bool store_numbers() { return false; }

    // Makes store() ignore masks: vectors and colours stay as they are stored. Call this before rows are stored.
    virtual void keep_masked() {}

    // decode() and store() may touch more rows than they make: up to the next multiple of this number.
    [[nodiscard]] virtual int block_rows() const { return kBlockEdge; }
    // The rows that memory must have room for if `count` rows are made.
    [[nodiscard]] int held_rows(int count) const { return whole_blocks(count, block_rows()); }

    // Decodes rows [first, first + count) into `rows`, row_bytes() each, which has room for held_rows(count). Throws
    // std::bad_alloc. Errors: bad_data, io, out_of_memory.
    virtual Result<void> decode(int first, int count, std::byte* rows) = 0;

    // Whether peek() may read rows before decode() has reached them.
    [[nodiscard]] virtual bool can_peek() const { return is_random(); }
    // Decodes any rows; decode() returns them again. Precondition: can_peek(); no other thread decodes.
    virtual Result<void> peek(int first, int count, std::byte* rows) { return decode(first, count, rows); }

    // Checks, after the last row, that the file ends as it should. Errors: as decode().
    virtual Result<void> finish() { return {}; }

    // Converts decoded rows to rows [first, end) of `image`, which has a plane for each of names() and room for
    // held_rows(end - first) rows. Any thread may call this, even while another thread is in decode().
    virtual void store(const std::byte* rows, int first, int end, Image& image) const = 0;

    // Reads the planes of the whole picture. Use it instead of decode() and finish(). Throws std::bad_alloc. Errors: as
    // decode().
    Result<Image> read_all();

    // Passes all rows, some at a time, to take(image, first, count): rows 0 to count - 1 of the image are rows first,
    // first + 1, ... of the picture. Use it instead of decode() and finish(). Throws std::bad_alloc. Errors: as
    // decode(), for the file `name`; those of take().
    using TakeRows = std::function<Result<void>(Image& rows, int first, int count)>;
    Result<void> visit(const std::string& name, const TakeRows& take);

protected:
    void describe(Extent extent, std::vector<std::string> names, std::size_t row_bytes, SampleKind sample, int bits);
    // A mark of heights is no mark of normals.
    void describe_mark(std::string mark);
    void describe_orientation(int orientation, bool is_turned);

    PictureHead head_;
};

// Opens the picture in `file`, which must outlive the rows. Errors: those of read_image() that the header reveals.
Result<std::unique_ptr<RowSource>> open_rows(InputFile& file, const ReadOptions& options);

// Reads the whole picture if it could be opened. Errors: that of opening; as RowSource::read_all().
Result<Image> read_all(Result<std::unique_ptr<RowSource>> rows);

// Does what read_image(path) does, for an open file. Errors name the file.
Result<Image> read_image(InputFile& file, const ReadOptions& options);

}  // namespace tex::inline v1
