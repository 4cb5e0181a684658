// SPDX-License-Identifier: Apache-2.0

#include <tex/container.h>

#include <algorithm>
#include <cctype>
#include <string>

#include "files/input_file.h"
#include "formats/dds/dds.h"
#include "formats/exr/exr.h"
#include "formats/ktx2/ktx2.h"
#include "formats/png/png.h"
#include "formats/reader/reader.h"
#include "formats/texture_rows.h"
#include "threads/guard.h"

namespace tex {
namespace {

struct ExtensionRow {
    std::string_view extension;
    Container container;
};

constexpr ExtensionRow kExtensions[] = {
    {"dds", Container::dds},  {"ktx2", Container::ktx2}, {"png", Container::png}, {"exr", Container::exr},
    {"tif", Container::tiff}, {"tiff", Container::tiff}, {"tga", Container::tga}, {"bmp", Container::bmp},
    {"jpg", Container::jpeg}, {"jpeg", Container::jpeg},
};

// The letters behind the last dot of the path's last part, in lower case; without one the text is empty.
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

}  // namespace

std::optional<Container> container_of(std::string_view path) {
    const std::string extension = extension_of(path);
    for (const ExtensionRow& row : kExtensions) {
        if (row.extension == extension) return row.container;
    }
    return std::nullopt;
}

bool can_hold(Container container, Encoding encoding) {
    const auto among = [&](std::initializer_list<Encoding> encodings) {
        return std::find(encodings.begin(), encodings.end(), encoding) != encodings.end();
    };
    switch (container) {
        case Container::dds:
        case Container::ktx2: return true;
        case Container::png: return among({Encoding::rgb8, Encoding::rgba8, Encoding::rgb16, Encoding::ag8});
        case Container::exr: return among({Encoding::half, Encoding::float_});
        case Container::tiff:
            return among(
                {Encoding::rgb8, Encoding::rgba8, Encoding::rgb16, Encoding::ag8, Encoding::half, Encoding::float_});
        case Container::tga: return among({Encoding::rgb8, Encoding::rgba8, Encoding::ag8});
        case Container::bmp:
        case Container::jpeg: return among({Encoding::rgb8});
    }
    return false;
}

bool can_hold_levels(Container container) {
    return container == Container::dds || container == Container::ktx2 || container == Container::exr;
}

Encoding default_encoding(Container container) {
    switch (container) {
        case Container::dds:
        case Container::ktx2: return Encoding::dxt5nm;
        case Container::tiff: return Encoding::rgb16;
        case Container::exr: return Encoding::half;
        default: return Encoding::rgb8;
    }
}

Result<std::vector<std::byte>> encode_file(const Texture& texture, Container container, const WriteOptions& options) {
    return guarded([&]() -> Result<std::vector<std::byte>> {
        switch (container) {
            case Container::dds: return assemble(texture, dds_layout(head_of(texture), options));
            case Container::ktx2: return assemble(texture, ktx2_layout(head_of(texture)));
            case Container::png: return encode_png(texture);
            case Container::exr: return encode_exr(texture);
            case Container::tiff:
            case Container::tga:
            case Container::bmp:
            case Container::jpeg: return encode_with_reader(texture, container, options.reader);
        }
        return Error{ErrorCode::bad_option, {}, "no such container"};
    });
}

Result<void> write_texture(const std::string& path, const Texture& texture, const WriteOptions& options) {
    const std::optional<Container> container = container_of(path);
    if (!container) {
        return Error{ErrorCode::bad_option, path, "the extension names no kind of file that can be written"};
    }
    const Result<std::vector<std::byte>> bytes = encode_file(texture, *container, options);
    if (!bytes) return Error{bytes.error().code, path, bytes.error().reason};
    return write_file(path, *bytes, options);
}

Result<Texture> read_texture(const std::string& path, const ReadOptions& options) {
    return guarded([&]() -> Result<Texture> {
        Result<InputFile> file = InputFile::open(path);
        if (!file) return file.error();
        return read_texture(*file, options);
    });
}

Result<Texture> decode_file(const std::byte* data, std::size_t size, const std::string& name,
                            const ReadOptions& options) {
    return guarded([&]() -> Result<Texture> {
        if (is_dds(data, size)) return decode_dds(data, size, name, options);
        if (is_ktx2(data, size)) return decode_ktx2(data, size, name, options);
        return Error{ErrorCode::bad_data, name, size == 0 ? "the file is empty" : "neither a DDS nor a KTX2 file"};
    });
}

}  // namespace tex
