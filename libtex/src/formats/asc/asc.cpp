// SPDX-License-Identifier: Apache-2.0

#include "formats/asc/asc.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "formats/asc/asc_words.h"
#include "formats/size_limits.h"
#include "formats/words.h"
#include "threads/no_throw.h"

namespace tex::inline v1 {
namespace {

// The words of the header.
enum AscKey {
    kColumns,
    kRows,
    kCellSize,
    kCellWidth,
    kCellHeight,
    kNoDataValue,
    kXCorner,
    kXCenter,
    kYCorner,
    kYCenter
};
constexpr std::string_view kAscKeys[] = {"ncols",        "nrows",     "cellsize",  "dx",        "dy",
                                         "nodata_value", "xllcorner", "xllcenter", "yllcorner", "yllcenter"};
constexpr std::size_t kAscKeyCount = std::size(kAscKeys);
constexpr double kUsualNoData = -9999.0;

std::size_t key_of(std::string_view word) {
    const auto* const found = std::find(std::begin(kAscKeys), std::end(kAscKeys), in_lower_case(word));
    return static_cast<std::size_t>(found - std::begin(kAscKeys));
}

struct AscHeader {
    std::optional<double> values[kAscKeyCount];

    [[nodiscard]] const std::optional<double>& operator[](AscKey key) const { return values[key]; }
};

// Reads up to the first height, which is then the next word.
Result<AscHeader> read_asc_header(WordReader& words) {
    AscHeader header;
    while (true) {
        const Result<std::string_view> word = words.next();
        if (!word) return word.error();
        if (word->empty() || number_in(*word)) break;
        const std::size_t key = key_of(*word);
        if (key == kAscKeyCount) return words.error(words.shown() + " is not a word of an ESRI ASCII grid");
        const std::string name(kAscKeys[key]);
        if (header.values[key]) return words.error(name + " appears twice");
        const Result<std::string_view> number = words.next();
        if (!number) return number.error();
        header.values[key] = number_in(*number);
        if (!header.values[key]) return words.error(words.shown() + " is not a number of " + name);
    }
    words.put_back();
    return header;
}

// A count as claimed_extent() takes it: what is not a count becomes 0, and what is too large stays so.
std::int64_t count_of(double value) {
    constexpr double kMost = 1e9;
    if (!(value >= 1.0) || value != std::floor(value)) return 0;
    return static_cast<std::int64_t>(std::min(value, kMost));
}

Result<Extent> asc_extent(const InputFile& file, const AscHeader& header, const ReadOptions& options) {
    for (const AscKey key : {kColumns, kRows}) {
        if (!header[key])
            return Error{ErrorCode::bad_data, file.path(), "the header lacks " + std::string(kAscKeys[key])};
    }
    const Result<Extent> extent =
        claimed_extent(file.path(), count_of(*header[kColumns]), count_of(*header[kRows]), options);
    if (!extent) return extent;
    // A height takes a digit and a blank.
    const Result<void> fits =
        check_claim(file.path(), *extent, 2.0 * static_cast<double>(extent->texels()) - 1.0, *file.size(), 1.0);
    return fits ? extent : Result<Extent>(fits.error());
}

// Where the cells are; rows come from the north.
GridPlace place_of(const AscHeader& header, Extent extent) {
    GridPlace place;
    const std::optional<double>&width = header[kCellWidth] ? header[kCellWidth] : header[kCellSize],
          &height = header[kCellHeight] ? header[kCellHeight] : header[kCellSize];
    if (!width || !height) return place;
    place.model = GridModel::numbers;
    place.column_east = std::abs(*width);
    place.row_north = -std::abs(*height);
    const auto first = [&](AscKey corner, AscKey center, double step) {
        return header[center] ? *header[center] : header[corner].value_or(0.0) + 0.5 * step;
    };
    place.east = first(kXCorner, kXCenter, place.column_east);
    place.north = first(kYCorner, kYCenter, -place.row_north) - place.row_north * (extent.height - 1);
    return place;
}

class AscRows final : public RowSource {
public:
    AscRows(WordReader words, const AscHeader& header, Extent extent) : words_(std::move(words)) {
        describe(extent, {"Y"}, static_cast<std::size_t>(extent.width) * sizeof(float), SampleKind::floating, 32);
        head_.samples = {.kind = 3, .bits = 32, .has_place = 1, .place = place_of(header, extent)};
        head_.no_data = float_of(header[kNoDataValue].value_or(kUsualNoData));
        head_.is_no_data_assumed = !header[kNoDataValue].has_value();
    }

    Result<void> decode(int first, int count, std::byte* rows) override {
        const std::int64_t texels = static_cast<std::int64_t>(extent().width) * count;
        for (std::int64_t i = 0; i < texels; ++i, rows += sizeof(float)) {
            const Result<float> height = next_height(static_cast<std::int64_t>(extent().width) * first + i);
            if (!height) return height.error();
            std::memcpy(rows, &*height, sizeof(float));
        }
        return {};
    }

    Result<void> finish() override {
        const Result<std::string_view> word = words_.next();
        if (!word) return word.error();
        return word->empty() ? Result<void>() : Result<void>(words_.error(words_.shown() + " after the last height"));
    }

    void store(const std::byte* rows, int first, int end, Image& image) const override {
        for (int j = first; j < end; ++j, rows += row_bytes())
            std::memcpy(image.planes.front().row(j), rows, row_bytes());
    }

private:
    Result<float> next_height(std::int64_t done) {
        const Result<std::string_view> word = words_.next();
        if (!word) return word.error();
        if (word->empty())
            return words_.error("the file ends after " + std::to_string(done) + " of " +
                                std::to_string(extent().texels()) + " heights");
        const std::optional<double> number = number_in(*word);
        if (!number) return words_.error(words_.shown() + " is not a number");
        return float_of(*number);
    }

    WordReader words_;
};

}  // namespace

bool may_be_asc(std::span<const std::byte> head) {
    std::string_view text(reinterpret_cast<const char*>(head.data()), head.size());
    constexpr std::string_view kByteOrderMark8 = "\xEF\xBB\xBF";
    if (text.substr(0, kByteOrderMark8.size()) == kByteOrderMark8) text.remove_prefix(kByteOrderMark8.size());
    const auto word_end = [&] { return std::find_if(text.begin(), text.end(), is_blank); };
    const auto skip_blanks = [&] {
        const auto* const first = std::find_if_not(text.begin(), text.end(), is_blank);
        text.remove_prefix(static_cast<std::size_t>(first - text.begin()));
    };
    skip_blanks();
    const auto length = static_cast<std::size_t>(word_end() - text.begin());
    if (key_of(text.substr(0, length)) == kAscKeyCount) return false;
    text.remove_prefix(length);
    skip_blanks();
    return !text.empty() && (text.front() == '+' || text.front() == '-' || text.front() == '.' ||
                             (text.front() >= '0' && text.front() <= '9'));
}

Result<std::unique_ptr<RowSource>> open_asc(InputFile& file, const ReadOptions& options) {
    return no_throw([&]() -> Result<std::unique_ptr<RowSource>> {
        if (const Result<void> settled = file.settle(largest_file(options)); !settled) return settled.error();
        WordReader words(file);
        const Result<AscHeader> header = read_asc_header(words);
        if (!header) return header.error();
        const Result<Extent> extent = asc_extent(file, *header, options);
        if (!extent) return extent.error();
        return std::unique_ptr<RowSource>(std::make_unique<AscRows>(std::move(words), *header, *extent));
    });
}

}  // namespace tex::inline v1
