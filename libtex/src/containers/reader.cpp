// SPDX-License-Identifier: Apache-2.0

#include "containers/reader.h"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <optional>
#include <string_view>

#include <half.h>

#include "base/guard.h"
#include "base/system_error.h"
#include "containers/claims.h"
#include "containers/reader_process.h"

namespace tex {
namespace {

// The first bytes of a kind of file, and OpenImageIO's name for it.
struct Mark {
    std::string_view bytes;
    std::string_view format;
};

using namespace std::string_view_literals;

constexpr Mark kMarks[] = {
    {"II*\0"sv, "tiff"},       {"MM\0*"sv, "tiff"},       {"II+\0"sv, "tiff"},      {"MM\0+"sv, "tiff"},
    {"\xff\xd8\xff"sv, "jpeg"}, {"BM"sv, "bmp"},           {"#?RADIANCE"sv, "hdr"},  {"#?RGBE"sv, "hdr"},
    {"8BPS"sv, "psd"},         {"GIF8"sv, "gif"},         {"RIFF"sv, "webp"},       {"P1"sv, "pnm"},
    {"P2"sv, "pnm"},           {"P3"sv, "pnm"},           {"P4"sv, "pnm"},          {"P5"sv, "pnm"},
    {"P6"sv, "pnm"},           {"Pf"sv, "pnm"},           {"PF"sv, "pnm"},          {"\x01\xda"sv, "sgi"},
    {"\0\0\0\x0cjP  "sv, "jpeg2000"}, {"\xff\x4f\xff\x51"sv, "jpeg2000"},
    {"SDPX"sv, "dpx"},         {"XPDS"sv, "dpx"},         {"\x80\x2a\x5f\xd7"sv, "cineon"},
    {"FOR4"sv, "iff"},         {"\x53\x80\xf6\x34"sv, "softimage"},
};

// TGA begins with its header at once: an id's length, the kind of palette (0, 1), the kind of picture, the palette, origin, extent and depth.
bool may_be_tga(std::span<const std::byte> head) {
    constexpr std::size_t kHeader = 18;
    if (head.size() < kHeader) return false;
    const auto at = [&](std::size_t k) { return static_cast<int>(head[k]); };
    const auto one_of = [](int v, std::initializer_list<int> list) { return std::find(list.begin(), list.end(), v) != list.end(); };
    const bool palette = at(1) == 1 && one_of(at(7), {15, 16, 24, 32});
    return (at(1) == 0 || palette) && one_of(at(2), {1, 2, 3, 9, 10, 11}) && one_of(at(16), {8, 15, 16, 24, 32}) &&
           (at(12) | at(13)) != 0 && (at(14) | at(15)) != 0;
}

std::optional<std::string> format_of(std::span<const std::byte> head) {
    const std::string_view text(reinterpret_cast<const char*>(head.data()), head.size());
    for (const Mark& mark : kMarks) {
        if (text.starts_with(mark.bytes)) return std::string(mark.format);
    }
    if (may_be_tga(head)) return "targa";
    return std::nullopt;
}

// -- what comes back -----------------------------------------------------------------------------------------

Error nonsense(const std::string& path) { return {ErrorCode::bad_data, path, "the decoder handed over nonsense"}; }

bool read_exactly(int fd, std::uint64_t offset, std::byte* to, std::size_t count) {
    while (count > 0) {
        const ssize_t n = pread(fd, to, count, static_cast<off_t>(offset));
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) return false;
        to += n;
        offset += static_cast<std::uint64_t>(n);
        count -= static_cast<std::size_t>(n);
    }
    return true;
}

bool write_exactly(int fd, std::uint64_t offset, std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const ssize_t n = pwrite(fd, bytes.data(), bytes.size(), static_cast<off_t>(offset));
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) return false;
        offset += static_cast<std::uint64_t>(n);
        bytes = bytes.subspan(static_cast<std::size_t>(n));
    }
    return true;
}

std::int64_t bytes_in(int fd) {
    struct stat status {};
    return fstat(fd, &status) == 0 ? status.st_size : 0;
}

// How the integers of one type become floats.
struct Scale {
    SampleKind kind = SampleKind::unorm;
    int bits = 8;   // significant ones
    int shift = 0;  // unsigned: from the container to the significant bits
};

// Decoders widen integers of n bits to whole bytes: by repeating bits, or by rounding v (2^m - 1) / (2^n - 1). Either way the
// upper n bits are v, and a value that came about otherwise (a palette's colour) betrays itself.
bool widened(std::uint32_t code, int n, int m) {
    const std::uint64_t v = code >> (m - n);
    std::uint64_t repeated = 0;
    for (int at = m - n; at > -n; at -= n) repeated |= at >= 0 ? v << at : v >> -at;
    const std::uint64_t top = (std::uint64_t{1} << n) - 1;
    const std::uint64_t scaled = v * ((std::uint64_t{1} << m) - 1);
    return code == repeated || code == scaled / top || code == (scaled + top / 2) / top || code == v << (m - n);
}

template <class T>
bool all_widened(const std::vector<std::byte>& row, std::size_t count, int bits) {
    for (std::size_t k = 0; k < count; ++k) {
        T code;
        std::memcpy(&code, row.data() + k * sizeof(T), sizeof(T));
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
    } else if constexpr (std::is_signed_v<T>) {
        const double value = static_cast<double>(code) / static_cast<double>(std::numeric_limits<T>::max());
        return static_cast<float>(std::max(value, -1.0));
    } else {
        const auto top = static_cast<double>((std::uint64_t{1} << scale.bits) - 1);
        return static_cast<float>(static_cast<double>(code >> scale.shift) / top);
    }
}

template <class T>
void store_row(const std::vector<std::byte>& row, const Scale& scale, Image& image, int j) {
    const std::size_t channels = image.planes.size();
    for (std::size_t c = 0; c < channels; ++c) {
        float* to = image.planes[c].row(j);
        const std::byte* from = row.data() + c * sizeof(T);
        for (int i = 0; i < image.extent().width; ++i, from += channels * sizeof(T)) {
            T code;
            std::memcpy(&code, from, sizeof(T));
            to[i] = to_float(code, scale);
        }
    }
}

// Calls visit(T{}) with the C++ type that stands for a ReaderType.
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

// Names as the decoder gives them, as far as they are names.
std::vector<std::string> plane_names(const ReaderHeader& header) {
    std::vector<std::string> names;
    for (int c = 0; c < header.channels; ++c) {
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

// All of the header that read_picture() relies on.
bool plausible(const ReaderHeader& header) {
    return header.channels >= 1 && header.channels <= kMaxReaderChannels && header.type <= ReaderType::f32 &&
           header.bits >= 1 && header.bits <= 8 * reader_type_bytes(header.type);
}

Result<Image> read_picture(const std::string& path, const ReaderHeader& header, int result, const ReadOptions& options) {
    if (!plausible(header)) return nonsense(path);
    const Result<Extent> extent = claimed_extent(path, header.width, header.height, options);
    if (!extent) return extent.error();
    const std::uint64_t row_size = row_bytes(header);
    const std::uint64_t all = kReaderDataOffset + row_size * static_cast<std::uint64_t>(header.height);
    if (static_cast<std::uint64_t>(bytes_in(result)) < all) return nonsense(path);

    std::vector<std::byte> row(row_size);
    const auto fetch = [&](int j) {
        return read_exactly(result, kReaderDataOffset + static_cast<std::uint64_t>(j) * row_size, row.data(), row.size());
    };
    return with_type(header.type, [&](auto zero) -> Result<Image> {
        using T = decltype(zero);
        constexpr bool kFloating = std::is_same_v<T, float> || std::is_same_v<T, Imath::half>;
        Scale scale{kFloating ? SampleKind::floating : SampleKind::unorm, static_cast<int>(sizeof(T) * 8), 0};
        if constexpr (!kFloating && std::is_signed_v<T>) scale.kind = SampleKind::snorm;
        if constexpr (std::is_unsigned_v<T>) {
            const auto bits = static_cast<int>(header.bits);
            bool narrow = bits < scale.bits;
            for (int j = 0; narrow && j < extent->height; ++j) {
                if (!fetch(j)) return nonsense(path);
                narrow = all_widened<T>(row, row.size() / sizeof(T), bits);
            }
            if (narrow) scale = {SampleKind::unorm, bits, scale.bits - bits};
        }
        Image image = make_image(*extent, plane_names(header));
        image.sample = scale.kind;
        image.bits = scale.bits;
        for (int j = 0; j < extent->height; ++j) {
            if (!fetch(j)) return nonsense(path);
            store_row<T>(row, scale, image, j);
        }
        return image;
    });
}

// The file as a descriptor that a process can open again: a stream goes to memory first.
Result<Descriptor> copy_to_memory(InputFile& file, const ReadOptions& options) {
    const Result<std::vector<std::byte>> bytes = file.read_rest(std::min(largest_file(options), options.reader_memory));
    if (!bytes) return bytes.error();
    Result<Descriptor> memory = memory_file(file.path());
    if (memory && !write_exactly(memory->get(), 0, *bytes)) return system_error(file.path(), errno, "a file in memory");
    return memory;
}

// -- what goes out -------------------------------------------------------------------------------------------

std::optional<ReaderType> texel_type(const FormatInfo& format) {
    if (format.block != 1 || format.channels == 2) return std::nullopt;
    if (format.sample == SampleKind::unorm) return format.bits == 8 ? ReaderType::u8 : ReaderType::u16;
    if (format.sample == SampleKind::floating) return format.bits == 16 ? ReaderType::f16 : ReaderType::f32;
    return std::nullopt;
}

struct Encoder {
    Container container;
    const char* format;  // as OpenImageIO names it
    bool deep;           // more than 8 bits
    bool alpha;
};

constexpr Encoder kEncoders[] = {
    {Container::tiff, "tiff", true, true},
    {Container::tga, "targa", false, true},
    {Container::bmp, "bmp", false, false},
    {Container::jpeg, "jpeg", false, false},
};

}  // namespace

Result<Image> read_with_reader(InputFile& file, const ReadOptions& options) {
    return guarded([&]() -> Result<Image> {
        const std::optional<std::string> format = format_of(file.head());
        if (!format) return Error{ErrorCode::bad_data, file.path(), "not a picture of any kind that is read here"};
        Descriptor memory;
        std::optional<int> input = file.whole_file();
        if (!input) {
            Result<Descriptor> copy = copy_to_memory(file, options);
            if (!copy) return std::move(copy).error();
            memory = std::move(*copy);
            input = memory.get();
        }
        const Result<Descriptor> result = memory_file(file.path());
        if (!result) return result.error();
        const Result<ReaderHeader> header =
            run_reader({file.path(), "decode", *format, *input, result.value().get()}, options);
        if (!header) return header.error();
        return read_picture(file.path(), *header, result.value().get(), options);
    });
}

Result<Image> read_with_reader(const std::string& path, const ReadOptions& options) {
    Result<InputFile> file = InputFile::open(path);
    if (!file) return std::move(file).error();
    return read_with_reader(*file, options);
}

Result<std::vector<std::byte>> encode_with_reader(const Texture& texture, Container container, const ReadOptions& options) {
    return guarded([&]() -> Result<std::vector<std::byte>> {
        const FormatInfo info = format_info(texture.format);
        const std::optional<ReaderType> type = texel_type(info);
        const auto* encoder = std::find_if(std::begin(kEncoders), std::end(kEncoders),
                                           [&](const Encoder& e) { return e.container == container; });
        if (!type || encoder == std::end(kEncoders) || texture.levels.empty() || (info.channels == 4 && !encoder->alpha) ||
            (*type != ReaderType::u8 && !encoder->deep)) {
            return Error{ErrorCode::unsupported, {},
                         std::string(name_of(kContainerNames, container)) + " does not hold " +
                             std::string(name_of(kFormatNames, texture.format))};
        }
        const Level& level = texture.levels.front();
        ReaderHeader header;
        header.width = level.extent.width;
        header.height = level.extent.height;
        header.channels = info.channels;
        header.type = *type;
        const Result<Descriptor> input = memory_file({});
        const Result<Descriptor> result = memory_file({});
        if (!input) return input.error();
        if (!result) return result.error();
        if (!write_exactly(input.value().get(), 0, std::as_bytes(std::span(&header, 1))) ||
            !write_exactly(input.value().get(), kReaderDataOffset, level.bytes)) {
            return system_error({}, errno, "a file in memory");
        }
        const Result<ReaderHeader> reply =
            run_reader({{}, "encode", encoder->format, input.value().get(), result.value().get()}, options);
        if (!reply) return reply.error();
        const auto held = static_cast<std::uint64_t>(bytes_in(result.value().get()));
        if (held < kReaderDataOffset || reply.value().bytes > held - kReaderDataOffset) return nonsense({});
        std::vector<std::byte> bytes(reply.value().bytes);
        if (!read_exactly(result.value().get(), kReaderDataOffset, bytes.data(), bytes.size())) return nonsense({});
        return bytes;
    });
}

}  // namespace tex
