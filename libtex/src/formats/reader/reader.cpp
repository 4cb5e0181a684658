// SPDX-License-Identifier: Apache-2.0

#include "formats/reader/reader.h"

#include <algorithm>
#include <cerrno>
#include <climits>
#include <cmath>
#include <cstring>
#include <optional>
#include <string_view>
#include <utility>

#include <half.h>

#include "files/system_error.h"
#include "formats/file_types.h"
#include "formats/normal_mark.h"
#include "formats/reader/reader_process.h"
#include "threads/no_throw.h"

namespace tex::inline v1 {
namespace {

// -- what goes out -------------------------------------------------------------------------------------------

// Precondition: the reader's codecs can hold the format.
ReaderType texel_type(const FormatInfo& format) {
    if (format.sample == SampleKind::unorm) return format.bits == 8 ? ReaderType::u8 : ReaderType::u16;
    return format.bits == 16 ? ReaderType::f16 : ReaderType::f32;
}

Result<ReaderHeader> describe_reader(ReaderProgram program, const ReadOptions& options) {
    const Result<Descriptor> input = memory_file({});
    const Result<Descriptor> result = memory_file({});
    if (!input) return input.error();
    if (!result) return result.error();
    return run_reader({program, {}, "describe", "-", input->get(), result->get()}, options);
}

}  // namespace

Result<ReaderInfo> reader_info(const ReadOptions& options) {
    return no_throw([&]() -> Result<ReaderInfo> {
        const Result<std::string> program = find_reader(options);
        if (!program) return program.error();
        const Result<ReaderHeader> reply = describe_reader(ReaderProgram::pictures, options);
        if (!reply) return reply.error();
        if (reply->landlock > INT_MAX) return invalid_answer({});
        // Without tex-reader-oiio there is no version.
        const Result<ReaderHeader> oiio = describe_reader(ReaderProgram::other_pictures, options);
        const std::string version = oiio ? std::string(oiio->reason, strnlen(oiio->reason, sizeof oiio->reason)) : "";
        const bool sound = std::all_of(version.begin(), version.end(), [](char c) { return c > 0x20 && c < 0x7f; });
        if (!sound) return invalid_answer({});
        return ReaderInfo{*program, version, static_cast<int>(reply->landlock),
                          (reply->sandboxed & kFilesRestricted) != 0, (reply->sandboxed & kCallsFiltered) != 0};
    });
}

Result<InputFile> decode_with_reader(InputFile& file, const std::string& format, const ReadOptions& options) {
    return no_throw([&]() -> Result<InputFile> {
        if (file.size()) {
            if (const Result<void> rewound = file.rewind(); !rewound) return rewound.error();
        }
        Descriptor copy;
        const Result<int> input = descriptor_of(file, options, copy);
        if (!input) return input.error();
        Result<Descriptor> result = memory_file(file.path());
        if (!result) return std::move(result).error();
        const ReaderJob job{program_for(format), file.path(), "decode", format, *input, result->get()};
        if (const Result<ReaderHeader> reply = run_reader(job, options); !reply) return reply.error();
        return InputFile::from_descriptor(file.path(), std::move(*result), kReaderDataOffset);
    });
}

Result<ReaderPicture> ReaderPicture::open(Container container, const TextureHead& head, const WriteOptions& options) {
    const FormatInfo info = format_info(head.format);
    const FileType& type = file_type_of(container);
    if (Result<void> held = check_holds(type, head.format, options); !held) return held.error();
    if (type.reader_name == nullptr)
        return Error{ErrorCode::unsupported, {}, "nothing that the reader process encodes"};
    if (std::max(head.extent.width, head.extent.height) > type.longest_side) {
        return Error{ErrorCode::unsupported,
                     {},
                     std::string(name_of(kContainerNames, container)) + " holds at most " +
                         std::to_string(type.longest_side) + " texels a side"};
    }
    ReaderHeader header;
    header.quality = static_cast<std::uint32_t>(options.jpeg_quality);
    header.width = head.extent.width;
    header.height = head.extent.height;
    header.channels = info.channels;
    header.type = texel_type(info);
    description_of(normal_mark(head)).copy(header.description, sizeof header.description - 1);
    Result<Descriptor> rows = memory_file({});
    if (!rows) return rows.error();
    if (!write_exactly(rows->get(), 0, std::as_bytes(std::span(&header, 1))))
        return system_error({}, errno, "a file in memory");
    ReaderPicture picture;
    picture.options_ = options.reader;
    picture.format_ = type.reader_name;
    picture.rows_ = std::move(*rows);
    picture.row_bytes_ = row_bytes(header);
    return picture;
}

Result<void> ReaderPicture::put(int first, std::span<const std::byte> rows) const {
    const std::uint64_t offset = kReaderDataOffset + static_cast<std::uint64_t>(first) * row_bytes_;
    if (!write_exactly(rows_.get(), offset, rows)) return system_error({}, errno, "a file in memory");
    return {};
}

Result<std::vector<std::byte>> ReaderPicture::encode() const {
    const Result<Descriptor> result = memory_file({});
    if (!result) return result.error();
    const Result<ReaderHeader> reply =
        run_reader({program_for(format_), {}, "encode", format_, rows_.get(), result->get()}, options_);
    if (!reply) return reply.error();
    return answered_bytes({}, result->get(), *reply);
}

Result<std::vector<std::byte>> encode_with_reader(const Texture& texture, Container container,
                                                  const WriteOptions& options) {
    return no_throw([&]() -> Result<std::vector<std::byte>> {
        if (texture.levels.empty()) return Error{ErrorCode::unsupported, {}, "a texture without levels"};
        const Result<ReaderPicture> picture = ReaderPicture::open(container, head_of(texture), options);
        if (!picture) return picture.error();
        if (const Result<void> put = picture->put(0, texture.levels.front().bytes); !put) return put.error();
        return picture->encode();
    });
}

}  // namespace tex::inline v1
