// SPDX-License-Identifier: Apache-2.0

#include "formats/reader/reader.h"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <climits>
#include <cmath>
#include <cstring>
#include <optional>
#include <string_view>

#include <half.h>

#include "files/system_error.h"
#include "formats/claims.h"
#include "formats/reader/reader_process.h"
#include "formats/reader/reader_rows.h"
#include "threads/guard.h"

namespace tex {
namespace {

std::int64_t bytes_in(int fd) {
    struct stat status {};
    return fstat(fd, &status) == 0 ? status.st_size : 0;
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
        const Result<std::unique_ptr<RowSource>> rows = open_reader_rows(file, options);
        if (!rows) return rows.error();
        return (*rows)->read_all();
    });
}

Result<ReaderInfo> reader_info(const ReadOptions& options) {
    return guarded([&]() -> Result<ReaderInfo> {
        const Result<std::string> program = find_reader(options);
        if (!program) return program.error();
        const Result<Descriptor> input = memory_file({});
        const Result<Descriptor> result = memory_file({});
        if (!input) return input.error();
        if (!result) return result.error();
        const Result<ReaderHeader> reply = run_reader({{}, "describe", "-", input->get(), result->get()}, options);
        if (!reply) return reply.error();
        const std::string version(reply->reason, strnlen(reply->reason, sizeof reply->reason));
        const bool sound = std::all_of(version.begin(), version.end(), [](char c) { return c > 0x20 && c < 0x7f; });
        if (!sound || reply->landlock > INT_MAX) return nonsense({});
        return ReaderInfo{*program, version, static_cast<int>(reply->landlock),
                          (reply->sandboxed & kFilesRestricted) != 0, (reply->sandboxed & kCallsFiltered) != 0};
    });
}

Result<Image> read_with_reader(const std::string& path, const ReadOptions& options) {
    Result<InputFile> file = InputFile::open(path);
    if (!file) return std::move(file).error();
    return read_with_reader(*file, options);
}

Result<std::vector<std::byte>> encode_with_reader(const Texture& texture, Container container,
                                                  const ReadOptions& options) {
    return guarded([&]() -> Result<std::vector<std::byte>> {
        const FormatInfo info = format_info(texture.format);
        const std::optional<ReaderType> type = texel_type(info);
        const auto* encoder = std::find_if(std::begin(kEncoders), std::end(kEncoders),
                                           [&](const Encoder& e) { return e.container == container; });
        if (!type || encoder == std::end(kEncoders) || texture.levels.empty() ||
            (info.channels == 4 && !encoder->alpha) || (*type != ReaderType::u8 && !encoder->deep)) {
            return Error{ErrorCode::unsupported,
                         {},
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
