// SPDX-License-Identifier: Apache-2.0
// row_source.h: a picture that is read a few rows at a time.
//
// Decoding comes first and in order, as decoders want it; what was decoded becomes floats (see Image) later, by any
// thread. So the two can run beside each other.

#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <tex/image.h>
#include <tex/image_io.h>
#include <tex/result.h>

#include "files/input_file.h"

namespace tex {

class RowSource {
public:
    RowSource() = default;
    RowSource(const RowSource&) = delete;
    RowSource& operator=(const RowSource&) = delete;
    virtual ~RowSource() = default;

    [[nodiscard]] Extent extent() const { return extent_; }
    [[nodiscard]] const std::vector<std::string>& names() const { return names_; }  // of the channels
    [[nodiscard]] std::size_t row_bytes() const { return row_bytes_; }              // of a decoded row
    [[nodiscard]] SampleKind sample() const { return sample_; }                     // this and the next two as in Image
    [[nodiscard]] int bits() const { return bits_; }
    [[nodiscard]] const std::string& normal_encoding() const { return normal_encoding_; }

    // Rows that the file holds together: decode() costs least where `first` is a multiple of it, and `count` too or up
    // to the last row.
    [[nodiscard]] virtual int rows_together() const { return 1; }
    // Whether any rows may be decoded at any time, by several threads at once. If not, rows are decoded from the top,
    // once, without gaps.
    [[nodiscard]] virtual bool is_random() const { return false; }

    // Only these planes are looked at; what is in the others does not matter. To be called before rows are stored.
    virtual void choose_planes(const std::vector<bool>&) {}

    // Decodes rows [first, first + count) into `rows`, row_bytes() each; there is room for whole blocks
    // (blocks/extent.h). Throws std::bad_alloc. Errors: bad_data, io, out_of_memory.
    virtual Result<void> decode(int first, int count, std::byte* rows) = 0;

    // Whether rows may be looked at before decode() has come to them.
    [[nodiscard]] virtual bool can_peek() const { return is_random(); }
    // As decode(), of any rows; decode() gives them again. Precondition: can_peek(); no other thread decodes.
    virtual Result<void> peek(int first, int count, std::byte* rows) { return decode(first, count, rows); }

    // Makes sure, after the last row, that the file ends as it should. Errors: as decode().
    virtual Result<void> finish() { return {}; }

    // Decoded rows become rows [first, end) of `image`, which has a plane for each of names() and room for whole
    // blocks. Any thread may call, also beside decode().
    virtual void store(const std::byte* rows, int first, int end, Image& image) const = 0;

    // The planes of the whole picture; instead of decode() and finish(). Throws std::bad_alloc. Errors: as decode().
    Result<Image> read_all();

    // Shows all rows, some at a time, to take(image, first, count): rows 0 to count - 1 of the image are rows first,
    // first + 1, ... of the picture. Instead of decode() and finish(). Throws std::bad_alloc. Errors: as decode(), of
    // the file `name`; those of take().
    using TakeRows = std::function<Result<void>(Image& rows, int first, int count)>;
    Result<void> visit(const std::string& name, const TakeRows& take);

protected:
    void describe(Extent extent, std::vector<std::string> names, std::size_t row_bytes) {
        extent_ = extent;
        names_ = std::move(names);
        row_bytes_ = row_bytes;
    }
    void describe_samples(SampleKind sample, int bits, std::string normal_encoding = {}) {
        sample_ = sample;
        bits_ = bits;
        normal_encoding_ = std::move(normal_encoding);
    }

private:
    Extent extent_;
    std::vector<std::string> names_;
    std::size_t row_bytes_ = 0;
    SampleKind sample_ = SampleKind::unorm;
    int bits_ = 8;
    std::string normal_encoding_;
};

// The picture in `file`, which must outlive it. Errors: as read_image(), those that a header tells.
Result<std::unique_ptr<RowSource>> open_rows(InputFile& file, const ReadOptions& options);

// The whole picture, once it is open. Errors: that of opening; as RowSource::read_all().
Result<Image> read_all(Result<std::unique_ptr<RowSource>> rows);

// As read_image(path), of an open file. Errors name the file.
Result<Image> read_image(InputFile& file, const ReadOptions& options);

}  // namespace tex
