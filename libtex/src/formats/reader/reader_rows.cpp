// SPDX-License-Identifier: Apache-2.0

#include "formats/reader/reader_rows.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <iterator>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>

#include <half.h>

#include "files/nameless_file.h"
#include "files/system_error.h"
#include "formats/normal_mark.h"
#include "formats/reader/reader.h"
#include "formats/reader/reader_process.h"
#include "formats/size_limits.h"
#include "threads/no_throw.h"

namespace tex::inline v1 {
namespace {

// The first bytes of a file type, and its name, which is that of OpenImageIO's format.
struct Mark {
    std::string_view bytes, format;
};

using namespace std::string_view_literals;

constexpr Mark kMarks[] = {
    {"II*\0"sv, "tiff"},
    {"MM\0*"sv, "tiff"},
    {"II+\0"sv, "tiff"},
    {"MM\0+"sv, "tiff"},
    {"\xff\xd8\xff"sv, "jpeg"},
    {"#?RADIANCE"sv, "hdr"},
    {"#?RGBE"sv, "hdr"},
    {"8BPS"sv, "psd"},
    {"GIF8"sv, "gif"},
    {"RIFF"sv, "webp"},
    {"P1"sv, "pnm"},
    {"P2"sv, "pnm"},
    {"P3"sv, "pnm"},
    {"P4"sv, "pnm"},
    {"P5"sv, "pnm"},
    {"P6"sv, "pnm"},
    {"Pf"sv, "pnm"},
    {"PF"sv, "pnm"},
    {"\x01\xda"sv, "sgi"},
    {"\0\0\0\x0cjP  "sv, "jpeg2000"},
    {"\xff\x4f\xff\x51"sv, "jpeg2000"},
    {"SDPX"sv, "dpx"},
    {"XPDS"sv, "dpx"},
    {"\x80\x2a\x5f\xd7"sv, "cineon"},
    {"FOR4"sv, "iff"},
    {"\x53\x80\xf6\x34"sv, "softimage"},
};

// The types that tex-reader decodes and encodes. tex-reader-oiio does the others.
constexpr std::string_view kOfTexReader[] = {"tiff", "jpeg", "webp", "exr"};

std::optional<std::string> format_of(std::span<const std::byte> head) {
    const std::string_view text(reinterpret_cast<const char*>(head.data()), head.size());
    for (const Mark& mark : kMarks) {
        if (text.starts_with(mark.bytes)) return std::string(mark.format);
    }
    return std::nullopt;
}

// How integers of one type become floats.
struct Scale {
    SampleKind kind = SampleKind::unorm;
    int bits = 8;          // the significant bits
    int shift = 0;         // for unsigned integers: right shift from the container to the significant bits
    bool numbers = false;  // integers stay what they are
};

// Decoders widen integers of n bits to whole bytes, either by repeating bits or by rounding v (2^m - 1) / (2^n - 1). In
// both cases the upper n bits are v. A value that was made in another way (a palette's colour) does not match.
bool widened(std::uint32_t code, int n, int m) {
    const std::uint64_t v = code >> (m - n);
    std::uint64_t repeated = 0;
    for (int at = m - n; at > -n; at -= n) repeated |= at >= 0 ? v << at : v >> -at;
    const std::uint64_t top = (std::uint64_t{1} << n) - 1;
    const std::uint64_t scaled = v * ((std::uint64_t{1} << m) - 1);
    return code == repeated || code == scaled / top || code == (scaled + top / 2) / top || code == v << (m - n);
}

template <class T>
bool all_widened(const std::byte* row, std::size_t count, int bits) {
    for (std::size_t k = 0; k < count; ++k) {
        T code;
        std::memcpy(&code, row + k * sizeof(T), sizeof(T));
        if (!widened(code, bits, static_cast<int>(sizeof(T) * 8))) return false;
    }
    return true;
}

template <class T>
float to_float(T code, const Scale& scale) {
    if constexpr (std::is_same_v<T, float>) {
        return code;
    } else if constexpr (std::is_same_v<T, Imath::half>) {
        return static_cast<float>(code);
    } else if (scale.numbers) {
        return static_cast<float>(code >> scale.shift);
    } else if constexpr (std::is_signed_v<T>) {
        const double value = static_cast<double>(code) / static_cast<double>(std::numeric_limits<T>::max());
        return static_cast<float>(std::max(value, -1.0));
    } else {
        const auto top = static_cast<double>((std::uint64_t{1} << scale.bits) - 1);
        return static_cast<float>(static_cast<double>(code >> scale.shift) / top);
    }
}

// Texels whose last channel, of all that the process hands over, is 0.
template <class T>
void mask_row(const std::byte* row, std::size_t channels, std::size_t masked, Image& image, int j) {
    const std::byte* mask = row + (channels - 1) * sizeof(T);
    for (int i = 0; i < image.extent().width; ++i, mask += channels * sizeof(T)) {
        if (!std::all_of(mask, mask + sizeof(T), [](std::byte byte) { return byte == std::byte{0}; })) continue;
        for (std::size_t c = 0; c < masked; ++c) image.planes[c].row(j)[i] = std::numeric_limits<float>::quiet_NaN();
    }
}

template <class T>
void store_row(const std::byte* row, std::size_t channels, const Scale& scale, Image& image, int j) {
    for (std::size_t c = 0; c < image.planes.size(); ++c) {
        float* to = image.planes[c].row(j);
        const std::byte* from = row + c * sizeof(T);
        for (int i = 0; i < image.extent().width; ++i, from += channels * sizeof(T)) {
            T code;
            std::memcpy(&code, from, sizeof(T));
            to[i] = to_float(code, scale);
        }
    }
}

// Calls visit(T{}) with the C++ type for a ReaderType.
template <class Visit>
auto with_type(ReaderType type, const Visit& visit) {
    switch (type) {
        case ReaderType::u8: return visit(std::uint8_t{});
        case ReaderType::s8: return visit(std::int8_t{});
        case ReaderType::u16: return visit(std::uint16_t{});
        case ReaderType::s16: return visit(std::int16_t{});
        case ReaderType::u32: return visit(std::uint32_t{});
        case ReaderType::s32: return visit(std::int32_t{});
        case ReaderType::f16: return visit(Imath::half{});
        case ReaderType::f32: break;
    }
    return visit(float{});
}

// The names that the decoder gives. Names that are not plain text are replaced.
std::vector<std::string> plane_names(const ReaderHeader& header) {
    std::vector<std::string> names;
    const int channels = header.channels - (header.mask == ReaderMask::own ? 1 : 0);
    for (int c = 0; c < channels; ++c) {
        const char* text = header.names[c];
        std::string name(text, strnlen(text, sizeof header.names[c]));
        const bool sound = !name.empty() && std::all_of(name.begin(), name.end(), [](char ch) {
            return static_cast<unsigned char>(ch) >= 0x20 && ch != 0x7f;
        });
        names.push_back(sound ? name : "channel" + std::to_string(c));
    }
    const bool alpha_last = names.size() == 2 && names[1] == "A";
    if (names.size() == 1 || alpha_last) names[0].assign(1, 'Y');
    return names;
}

// Checks every field of the header that later code relies on.
bool plausible(const ReaderHeader& header) {
    return header.channels >= 1 && header.channels <= kMaxReaderChannels && header.type <= ReaderType::f32 &&
           header.bits >= 1 && header.bits <= 8 * reader_type_bytes(header.type) && header.orientation <= 8 &&
           header.mask <= ReaderMask::alpha && (header.mask == ReaderMask::none || header.channels >= 2) &&
           header.absent_chunks <= header.chunks;
}

// What parts of the file that were never written mean, as a sentence.
std::string absent_text(const ReaderHeader& header, bool has_no_data) {
    const char* const kind = header.has_tiles != 0 ? " tile" : " strip";
    const std::string count = std::to_string(header.absent_chunks) + " of " + std::to_string(header.chunks) + kind +
                              (header.chunks == 1 ? "" : "s") + (header.absent_chunks == 1 ? " was" : " were") +
                              " never written; ";
    return count + (has_no_data ? "the texels there have the no-data value of the file"
                                : "the texels there are read as 0, because the file has no no-data value");
}

// A type that is known, but not read, and the program that makes PNG of it.
struct UnreadType {
    std::string_view name;
    std::size_t offset;
    std::string_view bytes;  // that files have there
    std::string_view program;
};

constexpr UnreadType kUnreadTypes[] = {
    {"AVIF", 4, "ftypavif", "avifdec"},      {"AVIF", 4, "ftypavis", "avifdec"}, {"HEIF", 4, "ftyphei", "heif-convert"},
    {"HEIF", 4, "ftypmif1", "heif-convert"}, {"JPEG XL", 4, "JXL \r\n", "djxl"}, {"JPEG XL", 0, "\xff\x0a", "djxl"},
};

Error unknown_type(const InputFile& file) {
    const auto head = file.head();
    for (const UnreadType& type : kUnreadTypes) {
        if (head.size() < type.offset + type.bytes.size() ||
            std::memcmp(head.data() + type.offset, type.bytes.data(), type.bytes.size()) != 0)
            continue;
        return {ErrorCode::unsupported, file.path(),
                std::string(type.name) + " is not supported; \"" + std::string(type.program) +
                    "\" makes PNG of it, with the losses that it has"};
    }
    return {ErrorCode::bad_data, file.path(), "not a picture, or of a type that is not supported"};
}

class ReaderRows final : public RowSource {
public:
    explicit ReaderRows(InputFile& file) : file_(file) {}

    // Starts the reader and waits for its first rows.
    Result<void> open(const ReadOptions& options);

    Result<void> decode(int first, int count, std::byte* rows) override;
    [[nodiscard]] bool can_peek() const override { return true; }
    Result<void> peek(int first, int count, std::byte* rows) override;
    Result<void> finish() override;
    bool store_numbers() override {
        scale_.numbers = true;
        head_.no_data = no_data_value();
        return true;
    }
    void store(const std::byte* rows, int first, int end, Image& image) const override;
    void keep_masked() override { keeps_masked_ = true; }

private:
    Result<void> start(const ReadOptions& options);
    Result<Scale> find_scale();
    [[nodiscard]] std::optional<float> no_data_value() const;
    [[nodiscard]] bool fetch(int first, int count, std::byte* rows) const {
        const std::uint64_t offset = kReaderDataOffset + static_cast<std::uint64_t>(first) * row_bytes();
        return read_exactly(result_.get(), offset, rows, row_bytes() * static_cast<std::size_t>(count));
    }

    InputFile& file_;
    Descriptor memory_;  // a copy of a stream
    Descriptor result_;
    std::optional<ReaderProcess> process_;
    ReaderHeader header_;  // as it was when the first rows arrived
    bool keeps_masked_ = false;
    Scale scale_;
};

Result<void> ReaderRows::start(const ReadOptions& options) {
    const std::optional<std::string> format = format_of(file_.head());
    if (!format) return unknown_type(file_);
    const Result<int> input = descriptor_of(file_, options, memory_);
    if (!input) return input.error();
    Result<Descriptor> result = memory_file(file_.path());
    if (!result) return result.error();
    result_ = std::move(*result);
    Result<ReaderProcess> process =
        ReaderProcess::start({program_for(*format), file_.path(), "decode", *format, *input, result_.get()}, options);
    if (!process) return process.error();
    process_ = std::move(*process);
    return {};
}

Result<void> ReaderRows::open(const ReadOptions& options) {
    if (Result<void> started = start(options); !started) return started;
    const Result<ReaderHeader> header = process_->wait_for_rows(1);
    if (!header) return header.error();
    if (!plausible(*header)) return invalid_answer(file_.path());
    const Result<Extent> extent = claimed_extent(file_.path(), header->width, header->height, options);
    if (!extent) return extent.error();
    // Checks what the process claims before memory is allocated for it.
    const std::uint64_t claimed = tex::row_bytes(*header) * static_cast<std::uint64_t>(extent->height);
    if (claimed > static_cast<std::uint64_t>(std::max<std::int64_t>(options.reader_memory, 0)))
        return invalid_answer(file_.path());
    header_ = *header;
    describe(*extent, plane_names(header_), tex::row_bytes(header_), scale_.kind, scale_.bits);
    const Result<Scale> scale = find_scale();
    if (!scale) return scale.error();
    scale_ = *scale;
    head_.sample = scale_.kind;
    head_.bits = scale_.bits;
    const std::string_view text(header_.description, strnlen(header_.description, sizeof header_.description));
    describe_mark(std::string(mark_in_description(text)));
    head_.no_data = no_data_value();
    if (!std::isfinite(header_.stored.scale) || !std::isfinite(header_.stored.offset))
        return invalid_answer(file_.path());
    head_.samples = header_.stored;
    head_.is_multiplied = header_.is_multiplied != 0;
    head_.is_masked = header_.mask != ReaderMask::none;
    if (head_.is_multiplied) head_.remark = kMultipliedText;
    if (header_.orientation > 1) describe_orientation(static_cast<int>(header_.orientation), true);
    if (header_.absent_chunks > 0) {
        head_.absent = absent_text(header_, head_.no_data.has_value());
        head_.remark += (head_.remark.empty() ? "" : "; ") + head_.absent;
    }
    return {};
}

// Whether integers of fewer bits than their container have been widened is known only when all of them have been read.
Result<Scale> ReaderRows::find_scale() {
    return with_type(header_.type, [&](auto zero) -> Result<Scale> {
        using T = decltype(zero);
        constexpr bool kFloating = std::is_same_v<T, float> || std::is_same_v<T, Imath::half>;
        Scale scale{kFloating ? SampleKind::floating : SampleKind::unorm, static_cast<int>(sizeof(T) * 8), 0};
        if constexpr (!kFloating && std::is_signed_v<T>) scale.kind = SampleKind::snorm;
        if constexpr (std::is_unsigned_v<T>) {
            const auto bits = static_cast<int>(header_.bits);
            if (bits >= scale.bits) return scale;
            if (const Result<ReaderHeader> done = process_->finish(); !done) return done.error();
            std::vector<std::byte> row(row_bytes());
            for (int j = 0; j < extent().height; ++j) {
                if (!fetch(j, 1, row.data())) return invalid_answer(file_.path());
                if (!all_widened<T>(row.data(), row.size() / sizeof(T), bits)) return scale;
            }
            scale = {SampleKind::unorm, bits, scale.bits - bits};
        }
        return scale;
    });
}

// What store() makes of samples that hold no data. None if no sample can have that value.
std::optional<float> ReaderRows::no_data_value() const {
    const double value = header_.no_data;
    if (header_.has_no_data == 0 || !std::isfinite(value)) return std::nullopt;
    return with_type(header_.type, [&](auto zero) -> std::optional<float> {
        using T = decltype(zero);
        if constexpr (std::is_integral_v<T>) {
            const double top = scale_.shift == 0 ? static_cast<double>(std::numeric_limits<T>::max())
                                                 : static_cast<double>((std::uint64_t{1} << scale_.bits) - 1);
            if (value < static_cast<double>(std::numeric_limits<T>::min()) || value > top || value != std::floor(value))
                return std::nullopt;
            return to_float(
                static_cast<T>(static_cast<std::uint64_t>(static_cast<std::int64_t>(value)) << scale_.shift), scale_);
        } else {
            constexpr double kMost = std::numeric_limits<float>::max();
            return to_float(static_cast<T>(static_cast<float>(std::clamp(value, -kMost, kMost))), scale_);
        }
    });
}

// All rows up to the requested ones are in memory, as they were decoded.
Result<void> ReaderRows::peek(int first, int count, std::byte* rows) {
    const Result<ReaderHeader> there =
        process_->wait_for_rows(static_cast<std::uint64_t>(first) + static_cast<std::uint64_t>(count));
    if (!there) return there.error();
    if (!fetch(first, count, rows)) return invalid_answer(file_.path());
    return {};
}

Result<void> ReaderRows::decode(int first, int count, std::byte* rows) {
    if (Result<void> there = peek(first, count, rows); !there) return there;
    // Rows that have been read are no longer needed in memory. If they cannot be released, they stay.
    const auto offset_of = [&](int row) { return kReaderDataOffset + static_cast<std::uint64_t>(row) * row_bytes(); };
    release_pages(result_.get(), offset_of(first), offset_of(first + count), kReaderDataOffset);
    return {};
}

Result<void> ReaderRows::finish() {
    const Result<ReaderHeader> done = process_->finish();
    if (!done) return done.error();
    return {};
}

void ReaderRows::store(const std::byte* rows, int first, int end, Image& image) const {
    const auto channels = static_cast<std::size_t>(header_.channels);
    const std::size_t masked = header_.mask == ReaderMask::none || keeps_masked_ ? 0 : channels - 1;
    with_type(header_.type, [&](auto zero) {
        for (int j = first; j < end; ++j, rows += row_bytes()) {
            store_row<decltype(zero)>(rows, channels, scale_, image, j);
            if (masked > 0) mask_row<decltype(zero)>(rows, channels, masked, image, j);
        }
    });
}

}  // namespace

ReaderProgram program_for(std::string_view format) {
    const std::string_view name = format.substr(0, format.find('/'));
    const bool own = std::find(std::begin(kOfTexReader), std::end(kOfTexReader), name) != std::end(kOfTexReader);
    return own ? ReaderProgram::pictures : ReaderProgram::other_pictures;
}

Result<std::unique_ptr<RowSource>> open_reader_rows(InputFile& file, const ReadOptions& options) {
    return no_throw([&]() -> Result<std::unique_ptr<RowSource>> {
        auto rows = std::make_unique<ReaderRows>(file);
        if (const Result<void> opened = rows->open(options); !opened) return opened.error();
        return std::unique_ptr<RowSource>(std::move(rows));
    });
}

}  // namespace tex::inline v1
