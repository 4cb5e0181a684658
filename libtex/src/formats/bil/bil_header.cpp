// SPDX-License-Identifier: Apache-2.0

#include "formats/bil/bil_header.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <string_view>

#include "formats/size_limits.h"
#include "formats/words.h"

namespace tex::inline v1 {
namespace {

enum BilKey {
    kBilRows,
    kBilColumns,
    kBilBands,
    kBilBits,
    kBilPixelType,
    kBilByteOrder,
    kBilSkip,
    kBilBandRow,
    kBilTotalRow,
    kBilNoData,
    kBilEast,
    kBilNorth,
    kBilWidth,
    kBilHeight,
    kBilSize,
    kBilWest,
    kBilSouth,
    kBilKeyCount
};
constexpr std::string_view kBilKeys[] = {
    "nrows",  "ncols",  "nbands", "nbits", "pixeltype", "byteorder", "skipbytes", "bandrowbytes", "totalrowbytes",
    "nodata", "ulxmap", "ulymap", "xdim",  "ydim",      "cellsize",  "xllcorner", "yllcorner"};

struct BilWords {
    std::string path;
    std::string values[kBilKeyCount];  // in lower case; empty if the header lacks the word

    [[nodiscard]] const std::string& operator[](BilKey key) const { return values[key]; }
    [[nodiscard]] Error wrong(BilKey key) const {
        return {ErrorCode::bad_data, path,
                std::string(kBilKeys[key]) + (values[key].empty() ? " is missing" : " is \"" + values[key] + "\"")};
    }
};

// The next word of a line, in lower case; empty at its end.
std::string next_word(std::string_view& line) {
    const auto* const first = std::find_if_not(line.begin(), line.end(), is_blank);
    const auto* const end = std::find_if(first, line.end(), is_blank);
    const std::string word = in_lower_case(std::string_view(first, static_cast<std::size_t>(end - first)));
    line.remove_prefix(static_cast<std::size_t>(end - line.begin()));
    return word;
}

Result<BilWords> words_of(std::string_view text, const std::string& path) {
    BilWords words{path, {}};
    for (int number = 1; !text.empty(); ++number) {
        const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
        std::string_view line = text.substr(0, end);
        text.remove_prefix(std::min(end + 1, text.size()));
        std::string word = next_word(line);
        if (number == 1 && word == "envi")
            return Error{ErrorCode::unsupported, path,
                         "a header of ENVI; \"gdal_translate -of GTiff\" makes a TIFF of its file"};
        if (word == "nodata_value") word = kBilKeys[kBilNoData];
        const auto* const found = std::find(std::begin(kBilKeys), std::end(kBilKeys), word);
        if (found != std::end(kBilKeys)) words.values[found - std::begin(kBilKeys)] = next_word(line);
    }
    return words;
}

// A whole number of at least `least`; `otherwise` if the header does not state it.
Result<std::int64_t> count_in(const BilWords& words, BilKey key, std::int64_t least,
                              std::optional<std::int64_t> otherwise) {
    constexpr std::int64_t kMost = std::int64_t{1} << 40;
    if (words[key].empty() && otherwise) return *otherwise;
    const auto value = whole_number_in(words[key]);
    if (!value || *value < least || *value > kMost) return words.wrong(key);
    return static_cast<std::int64_t>(*value);
}

// Without the word, the high byte comes first, as GDAL has it (frmts/raw/ehdrdataset.cpp).
Result<bool> is_big_endian(const BilWords& words) {
    const std::string& order = words[kBilByteOrder];
    if (order == "i" || order == "lsbfirst" || order == "intel") return false;
    if (order.empty() || order == "m" || order == "msbfirst" || order == "motorola") return true;
    return words.wrong(kBilByteOrder);
}

// Without the number of bits, the size of the file tells it, as in GDAL 3.6.2, for which 32 bits are then floats.
Result<RawSamples> samples_in(const BilWords& words, const std::optional<double>& no_data, bool is_float,
                              std::int64_t bytes) {
    const bool has_gaps = !words[kBilTotalRow].empty() || !words[kBilBandRow].empty();
    const bool is_guessed = words[kBilBits].empty() && !has_gaps && (bytes == 2 || bytes == 4);
    is_float = is_float || (is_guessed && bytes == 4);
    const Result<std::int64_t> bits = count_in(words, kBilBits, 1, is_float ? 32 : is_guessed ? 8 * bytes : 8);
    if (!bits) return bits.error();
    const Result<bool> big_endian = is_big_endian(words);
    if (!big_endian) return big_endian.error();
    const std::string& type = words[kBilPixelType];
    RawSamples samples{SampleKind::unorm, static_cast<int>(std::min<std::int64_t>(*bits, 1024)), *big_endian};
    if (type == "float" || (type.empty() && is_float))
        samples.kind = SampleKind::floating;
    else if (type == "signedint" || (type.empty() && no_data && *no_data < 0.0))
        samples.kind = SampleKind::snorm;
    else if (!type.empty() && type != "unsignedint")
        return words.wrong(kBilPixelType);
    const bool is_read =
        samples.bits == 32 || (samples.kind != SampleKind::floating && (samples.bits == 8 || samples.bits == 16));
    if (is_read) return samples;
    return Error{ErrorCode::unsupported, words.path,
                 std::to_string(samples.bits) + (type == "float" ? " bits of a float" : " bits of an integer") +
                     " are not supported"};
}

// Bytes from a row to the next.
Result<std::int64_t> pitch_in(const BilWords& words, std::int64_t row) {
    const Result<std::int64_t> band = count_in(words, kBilBandRow, row, row);
    if (!band) return band.error();
    return count_in(words, kBilTotalRow, *band, *band);
}

// Where the texels are: in the words of BIL, the middle of the first one; in those of GridFloat, the corner in the
// southwest. Nothing without a size that is a number.
GridPlace place_in(const BilWords& words, Extent extent) {
    const auto number = [&](BilKey key) { return number_in(words[key]); };
    const std::optional<double> size = number(kBilSize), width = number(kBilWidth), height = number(kBilHeight);
    GridPlace place;
    if (!size && !(width && height)) return place;
    place.model = GridModel::numbers;
    place.column_east = size ? *size : *width;
    place.row_north = -(size ? *size : *height);
    const std::optional<double> east = number(kBilEast), north = number(kBilNorth);
    place.east = east ? *east : number(kBilWest).value_or(0.0) + 0.5 * place.column_east;
    place.north = north ? *north : number(kBilSouth).value_or(0.0) - place.row_north * (extent.height - 0.5);
    return place;
}

}  // namespace

Result<RawTexels> read_bil_header(const std::vector<std::byte>& text, const std::string& path, bool is_float,
                                  std::int64_t file_bytes, const ReadOptions& options) {
    const Result<BilWords> found =
        words_of(std::string_view(reinterpret_cast<const char*>(text.data()), text.size()), path);
    if (!found) return found.error();
    const BilWords& words = *found;
    const Result<std::int64_t> width = count_in(words, kBilColumns, 0, {}), height = count_in(words, kBilRows, 0, {}),
                               bands = count_in(words, kBilBands, 1, 1), skip = count_in(words, kBilSkip, 0, 0);
    for (const Result<std::int64_t>* count : {&width, &height, &bands, &skip}) {
        if (!*count) return count->error();
    }
    if (*bands > 1) return Error{ErrorCode::unsupported, path, std::to_string(*bands) + " bands, but heights need one"};
    const Result<Extent> extent = claimed_extent(path, *width, *height, options);
    if (!extent) return extent.error();

    const std::optional<double> no_data = number_in(words[kBilNoData]);
    if (!no_data && !words[kBilNoData].empty()) return words.wrong(kBilNoData);
    const Result<RawSamples> samples =
        samples_in(words, no_data, is_float, std::max<std::int64_t>(0, file_bytes - *skip) / extent->texels());
    if (!samples) return samples.error();
    const Result<std::int64_t> pitch = pitch_in(words, *width * static_cast<std::int64_t>(samples->bytes()));
    if (!pitch) return pitch.error();

    RawTexels place{.extent = *extent, .samples = *samples, .first = *skip, .has_place = true};
    place.pitch = static_cast<std::size_t>(*pitch);
    place.place = place_in(words, *extent);
    if (no_data) place.no_data = float_of(*no_data);
    if (words[kBilByteOrder].empty() && samples->bits > 8)
        place.remark =
            "its header has no byteorder, so the high byte is read first; \"byteorder I\" there means the low "
            "byte first";
    if (words[kBilBits].empty() && samples->bits > 8 && samples->kind != SampleKind::floating) {
        place.remark += (place.remark.empty() ? "" : "; ") +
                        std::string("its header has no nbits, and its size means ") + std::to_string(samples->bits) +
                        " bits";
    }
    return place;
}

}  // namespace tex::inline v1
