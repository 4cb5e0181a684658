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
#include "formats/codecs.h"
#include "formats/reader/reader_process.h"
#include "threads/guard.h"

namespace tex {
namespace {

std::int64_t bytes_in(int fd) {
    struct stat status {};
    return fstat(fd, &status) == 0 ? status.st_size : 0;
}

// -- what goes out -------------------------------------------------------------------------------------------

// Precondition: the reader's codecs hold the format.
ReaderType texel_type(const FormatInfo& format) {
    if (format.sample == SampleKind::unorm) return format.bits == 8 ? ReaderType::u8 : ReaderType::u16;
    return format.bits == 16 ? ReaderType::f16 : ReaderType::f32;
}

}  // namespace

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

Result<std::vector<std::byte>> encode_with_reader(const Texture& texture, Container container,
                                                  const ReadOptions& options) {
    return guarded([&]() -> Result<std::vector<std::byte>> {
        const FormatInfo info = format_info(texture.format);
        const Codec& codec = codec_of(container);
        if (codec.reader_name == nullptr || texture.levels.empty() || !codec.holds(info)) {
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
        header.type = texel_type(info);
        const Result<Descriptor> input = memory_file({});
        const Result<Descriptor> result = memory_file({});
        if (!input) return input.error();
        if (!result) return result.error();
        if (!write_exactly(input.value().get(), 0, std::as_bytes(std::span(&header, 1))) ||
            !write_exactly(input.value().get(), kReaderDataOffset, level.bytes)) {
            return system_error({}, errno, "a file in memory");
        }
        const Result<ReaderHeader> reply =
            run_reader({{}, "encode", codec.reader_name, input.value().get(), result.value().get()}, options);
        if (!reply) return reply.error();
        const auto held = static_cast<std::uint64_t>(bytes_in(result.value().get()));
        if (held < kReaderDataOffset || reply.value().bytes > held - kReaderDataOffset) return nonsense({});
        std::vector<std::byte> bytes(reply.value().bytes);
        if (!read_exactly(result.value().get(), kReaderDataOffset, bytes.data(), bytes.size())) return nonsense({});
        return bytes;
    });
}

}  // namespace tex
