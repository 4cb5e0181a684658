// SPDX-License-Identifier: Apache-2.0

#include "formats/bmp/bmp.h"

#include <algorithm>
#include <cstring>
#include <utility>
#include <vector>

#include "formats/bmp/bmp_header.h"
#include "formats/bmp/bmp_rle.h"
#include "formats/byte_range.h"
#include "formats/bytes.h"
#include "formats/code_rows.h"
#include "formats/size_limits.h"
#include "threads/no_throw.h"

namespace tex::inline v1 {
namespace {

// A code of n bits as one of m: its bits repeated.
std::uint32_t widened_code(std::uint32_t code, int n, int m) {
    std::uint32_t wide = 0;
    for (int at = m - n; at > -n; at -= n) wide |= at >= 0 ? code << at : code >> -at;
    return wide;
}

class BmpRows final : public CodeRows {
public:
    BmpRows(const InputFile& file, BmpHeader header);

    // Checks that all rows are there.
    Result<void> find_rows();

    Result<void> decode(int first, int count, std::byte* rows) override;

private:
    [[nodiscard]] std::size_t width() const { return static_cast<std::size_t>(header_.extent.width); }
    Result<void> read_stored(int first, int count, std::vector<std::uint8_t>& stored) const;
    // Makes codes of a stored row. False if an index is beyond the palette.
    bool expand(const std::uint8_t* stored, std::uint8_t* out) const;
    bool expand_indices(const std::uint8_t* stored, std::uint8_t* out) const;
    template <class Code>
    void expand_fields(const std::uint8_t* stored, std::uint8_t* out) const;
    void expand_bytes(const std::uint8_t* stored, std::uint8_t* out) const;

    const InputFile& file_;
    const BmpHeader header_;
    const std::size_t stored_bytes_;                   // of a row, from one to the next
    std::vector<BmpRowStart> starts_;                  // only of RLE
    std::vector<std::vector<std::uint16_t>> widened_;  // for each field, what its codes become
};

BmpRows::BmpRows(const InputFile& file, BmpHeader header)
    : file_(file), header_(std::move(header)),
      stored_bytes_(header_.is_rle ? static_cast<std::size_t>(header_.extent.width) : header_.stride()) {
    const bool is_grey = !header_.palette.empty() && header_.is_grey;
    describe_codes(header_.extent, channel_names(is_grey ? 1 : header_.fields.size() == 4 ? 4 : 3), header_.bits);
    for (const BmpField& field : header_.fields) {
        std::vector<std::uint16_t> codes(std::size_t{1} << field.bits);
        for (std::size_t k = 0; k < codes.size(); ++k)
            codes[k] =
                static_cast<std::uint16_t>(widened_code(static_cast<std::uint32_t>(k), field.bits, header_.bits));
        widened_.push_back(std::move(codes));
    }
}

Result<void> BmpRows::find_rows() {
    if (header_.is_rle) {
        // 255 texels of one colour take two bytes. A picture of skipped texels alone takes none.
        constexpr double kMostTexels = 255.0 / 2.0;
        const Result<void> claim = check_claim(
            file_.path(), header_.extent, static_cast<double>(header_.extent.texels()), *file_.size(), kMostTexels);
        if (!claim) return claim;
        Result<std::vector<BmpRowStart>> starts = find_bmp_rows(file_, header_);
        if (!starts) return starts.error();
        starts_ = std::move(*starts);
        return {};
    }
    // Some programs do not fill the last row.
    const auto rows = static_cast<std::int64_t>(header_.stride()) * (header_.extent.height - 1) +
                      static_cast<std::int64_t>(header_.row_bytes());
    return *file_.size() - header_.first >= rows ? Result<void>() : Result<void>(ends_early(file_));
}

// Reads rows [first, first + count) in the order of the file.
Result<void> BmpRows::read_stored(int first, int count, std::vector<std::uint8_t>& stored) const {
    if (header_.is_rle) return read_bmp_rows(file_, header_, starts_, first, count, stored.data());
    const std::size_t bytes = header_.stride() * static_cast<std::size_t>(count - 1) + header_.row_bytes();
    const std::int64_t place = header_.first + static_cast<std::int64_t>(header_.stride()) * first;
    const Result<std::size_t> got = file_.read_at(place, reinterpret_cast<std::byte*>(stored.data()), bytes);
    if (!got) return got.error();
    return *got == bytes ? Result<void>() : Result<void>(ends_early(file_));
}

bool BmpRows::expand_indices(const std::uint8_t* stored, std::uint8_t* out) const {
    const auto depth = static_cast<std::size_t>(header_.is_rle ? 8 : header_.depth);
    const std::size_t channels = names().size();
    const unsigned most = (1u << depth) - 1;
    for (std::size_t i = 0, bit = 0; i < width(); ++i, bit += depth, out += channels) {
        const unsigned index = stored[bit / 8] >> (8 - depth - bit % 8) & most;
        if (index >= header_.palette.size()) return false;
        std::memcpy(out, header_.palette[index].data(), channels);
    }
    return true;
}

// Texels of 24 bits, and those of 32 bits without masks.
void BmpRows::expand_bytes(const std::uint8_t* stored, std::uint8_t* out) const {
    const auto step = static_cast<std::size_t>(header_.depth / 8);
    for (std::size_t i = 0; i < width(); ++i, stored += step, out += 3) {
        out[0] = stored[2];
        out[1] = stored[1];
        out[2] = stored[0];
    }
}

template <class Code>
void BmpRows::expand_fields(const std::uint8_t* stored, std::uint8_t* out) const {
    const std::size_t channels = header_.fields.size();
    for (std::size_t i = 0; i < width(); ++i, stored += header_.depth / 8) {
        std::uint32_t texel = 0;
        std::memcpy(&texel, stored, header_.depth == 16 ? 2 : 4);
        for (std::size_t c = 0; c < channels; ++c, out += sizeof(Code)) {
            const BmpField field = header_.fields[c];
            const auto code = static_cast<Code>(widened_[c][texel >> field.shift & ((1u << field.bits) - 1)]);
            std::memcpy(out, &code, sizeof code);
        }
    }
}

bool BmpRows::expand(const std::uint8_t* stored, std::uint8_t* out) const {
    if (!header_.palette.empty()) return expand_indices(stored, out);
    const auto is_byte = [](const BmpField& field, int shift) { return field.bits == 8 && field.shift == shift; };
    const std::vector<BmpField>& fields = header_.fields;
    if (fields.size() == 3 && is_byte(fields[0], 16) && is_byte(fields[1], 8) && is_byte(fields[2], 0))
        expand_bytes(stored, out);
    else if (header_.bits <= 8)
        expand_fields<std::uint8_t>(stored, out);
    else
        expand_fields<std::uint16_t>(stored, out);
    return true;
}

Result<void> BmpRows::decode(int first, int count, std::byte* rows) {
    std::vector<std::uint8_t> stored(stored_bytes_ * static_cast<std::size_t>(count));
    const int lowest = header_.from_top ? first : header_.extent.height - first - count;
    if (Result<void> read = read_stored(lowest, count, stored); !read) return read;
    for (int j = 0; j < count; ++j) {
        const int k = header_.from_top ? j : count - 1 - j;
        auto* const out = reinterpret_cast<std::uint8_t*>(rows) + static_cast<std::size_t>(j) * row_bytes();
        if (!expand(stored.data() + static_cast<std::size_t>(k) * stored_bytes_, out))
            return Error{ErrorCode::bad_data, file_.path(), "damaged: a texel has a colour that the palette lacks"};
    }
    return {};
}

}  // namespace

Result<std::unique_ptr<RowSource>> open_bmp(InputFile& file, const ReadOptions& options) {
    return no_throw([&]() -> Result<std::unique_ptr<RowSource>> {
        if (const Result<void> settled = file.settle(largest_file(options)); !settled) return settled.error();
        if (file.head().size() < kBmpFileHeader)
            return Error{ErrorCode::bad_data, file.path(), "damaged: the file ends within its header"};
        Result<BmpHeader> header = read_bmp_header(file, options);
        if (!header) return header.error();
        auto rows = std::make_unique<BmpRows>(file, std::move(*header));
        if (const Result<void> found = rows->find_rows(); !found) return found.error();
        return std::unique_ptr<RowSource>(std::move(rows));
    });
}

}  // namespace tex::inline v1
