// SPDX-License-Identifier: Apache-2.0

#include <tex/file.h>

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>

#include "fields/field_check.h"
#include "fields/file_fields.h"
#include "files/atomic_file.h"
#include "files/input_file.h"
#include "files/unfinished_files.h"
#include "formats/file_types.h"
#include "formats/reader/reader.h"
#include "formats/texture_rows.h"
#include "rows/codecs.h"
#include "rows/usable.h"
#include "threads/no_throw.h"

namespace tex::inline v1 {
namespace {

// The letters after the last dot of the last part of the path, in lower case; empty if there is no dot.
std::string extension_of(std::string_view path) {
    const std::size_t slash = path.rfind('/');
    const std::string_view file = slash == std::string_view::npos ? path : path.substr(slash + 1);
    const std::size_t dot = file.rfind('.');
    if (dot == std::string_view::npos) return {};
    std::string extension(file.substr(dot + 1));
    for (char& c : extension) {
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    }
    return extension;
}

// Whether `list`, for example ".tif, .tiff", contains `extension`, for example "tiff".
bool lists(std::string_view list, const std::string& extension) {
    const std::size_t at = list.find("." + extension);
    if (extension.empty() || at == std::string_view::npos) return false;
    const std::size_t end = at + 1 + extension.size();
    return end == list.size() || list[end] == ',' || lists(list.substr(end), extension);
}

// The compressed form of the file `bytes`.
Result<std::vector<std::byte>> compressed(const FileType& type, const FileLayout& layout, int level,
                                          const std::vector<std::byte>& bytes) {
    std::vector<std::byte> packed;
    const auto fetch = [&](std::uint64_t offset, std::size_t count) -> Result<std::vector<std::byte>> {
        const auto begin = bytes.begin() + static_cast<std::ptrdiff_t>(offset);
        return std::vector<std::byte>(begin, begin + static_cast<std::ptrdiff_t>(count));
    };
    const auto write = [&](std::uint64_t offset, std::span<const std::byte> source) -> Result<void> {
        packed.resize(std::max(packed.size(), static_cast<std::size_t>(offset) + source.size()));
        std::copy(source.begin(), source.end(), packed.begin() + static_cast<std::ptrdiff_t>(offset));
        return {};
    };
    if (const auto size = type.compress(layout, level, fetch, write); !size) return size.error();
    return packed;
}

}  // namespace

std::optional<Container> container_of(std::string_view path) {
    const std::string extension = extension_of(path);
    for (const Named<Container>& row : kContainerNames) {
        if (lists(row.meaning, extension)) return row.value;
    }
    return std::nullopt;
}

bool can_hold(Container container, Format format) { return file_type_of(container).holds(format); }

bool can_hold(Container container, Encoding encoding) { return can_hold(container, encoding_info(encoding).format); }

bool can_hold_blocks(Container container) { return can_hold(container, Encoding::dxt5nm); }

bool can_hold_levels(Container container) { return file_type_of(container).has_levels; }

bool can_compress(Container container) { return file_type_of(container).compress != nullptr; }

Encoding default_encoding(Container container) { return file_type_of(container).default_encoding; }

Result<void> validate(const WriteOptions& options) { return check_fields(options); }

Result<std::vector<std::byte>> encode_file(const Texture& texture, Container container, const WriteOptions& options,
                                           const Execution& execution) {
    return no_throw([&]() -> Result<std::vector<std::byte>> {
        if (const Result<void> usable = check_usable(texture); !usable) return usable.error();
        if (execution.progress && !execution.progress(0.0)) return Error{ErrorCode::cancelled, {}, "cancelled"};
        const FileType& type = file_type_of(container);
        if (!format_row(texture.format).codec->is_written) return check_holds(type, texture.format, {}).error();
        if (type.layout != nullptr || options.zstd != 0) {
            if (const Result<void> held = check_holds(type, texture.format, options); !held) return held.error();
            TextureHead head = head_of(texture);
            if (!type.has_levels) head.levels = 1;
            const FileLayout layout = type.layout(head, options);
            std::vector<std::byte> bytes = assemble(texture, layout);
            if (options.zstd > 0) return compressed(type, layout, options.zstd, bytes);
            return bytes;
        }
        if (type.open_target != nullptr) return encode_rows(type.open_target, texture, type.has_levels, execution);
        return encode_with_reader(texture, container, options);
    });
}

Result<void> write_texture(const std::string& path, const Texture& texture, const WriteOptions& options,
                           const Execution& execution) {
    const std::optional<Container> container = container_of(path);
    if (!container) {
        return Error{ErrorCode::bad_option, path, "the extension names no kind of file that can be written"};
    }
    const Result<std::vector<std::byte>> bytes = encode_file(texture, *container, options, execution);
    if (!bytes) return bytes.error().of(path);
    return write_file(path, *bytes, options);
}

Result<void> write_file(const std::string& path, const std::vector<std::byte>& bytes, const WriteOptions& options) {
    return write_atomically(path, bytes, AtomicFileOptions::of(options));
}

void remove_unfinished_files() noexcept { UnfinishedFile::remove_all(); }

Result<Texture> read_texture(const std::string& path, const ReadOptions& options) {
    return no_throw([&]() -> Result<Texture> {
        Result<InputFile> file = open_input(path, options);
        if (!file) return file.error();
        return read_texture(*file, options);
    });
}

Result<Texture> read_texture(std::span<const std::byte> bytes, const std::string& name, const ReadOptions& options) {
    return no_throw([&]() -> Result<Texture> {
        if (const FileType& type = file_type_for(bytes); type.parse != nullptr)
            return load_texture(type.parse, bytes.data(), bytes.size(), name, options);
        Result<InputFile> file = InputFile::from_memory(name, {bytes.begin(), bytes.end()});
        if (!file) return file.error();
        return read_texture(*file, options);
    });
}

}  // namespace tex::inline v1
