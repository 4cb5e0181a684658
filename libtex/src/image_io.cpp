// SPDX-License-Identifier: Apache-2.0

#include <tex/image_io.h>

#include <cstring>

#include <tex/container.h>
#include <tex/unpack.h>

#include "files/input_file.h"
#include "formats/exr/exr.h"
#include "formats/png/png.h"
#include "formats/reader/reader.h"
#include "formats/row_source.h"
#include "threads/guard.h"

namespace tex {
namespace {

bool is_texture(std::span<const std::byte> head) {
    constexpr unsigned char kDds[] = {'D', 'D', 'S', ' '};
    constexpr unsigned char kKtx2[] = {0xab, 'K', 'T', 'X', ' ', '2', '0', 0xbb};
    const auto begins_with = [&](const auto& mark) {
        return head.size() >= sizeof mark && std::memcmp(head.data(), mark, sizeof mark) == 0;
    };
    return begins_with(kDds) || begins_with(kKtx2);
}

Result<Image> read_base_level(InputFile& file, const ReadOptions& options) {
    const Result<std::vector<std::byte>> bytes = file.read_rest(largest_file(options));
    if (!bytes) return bytes.error();
    const Result<Texture> texture = decode_file(bytes.value().data(), bytes.value().size(), file.path(), options);
    if (!texture) return texture.error();
    return decode(*texture, 0);
}

}  // namespace

Result<Image> read_image(InputFile& file, const ReadOptions& options) {
    return guarded([&]() -> Result<Image> {
        Result<Image> image = is_png(file.head())       ? read_png(file, options)
                              : is_exr(file.head())     ? read_exr(file, options)
                              : is_texture(file.head()) ? read_base_level(file, options)
                                                        : read_with_reader(file, options);
        if (!image) return image.error().of(file.path());
        return image;
    });
}

Result<Image> read_image(const std::string& path, const ReadOptions& options) {
    return guarded([&]() -> Result<Image> {
        Result<InputFile> file = InputFile::open(path);
        if (!file) return std::move(file).error();
        return read_image(*file, options);
    });
}

}  // namespace tex
