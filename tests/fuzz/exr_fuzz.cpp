// SPDX-License-Identifier: Apache-2.0
// An EXR of any bytes is read or refused, as a picture and as a texture; rows from anywhere in it are those of the
// whole; a texture that is read can be written and read again.

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "formats/claims.h"
#include "formats/exr/exr.h"
#include "formats/exr/exr_reader.h"
#include "formats/exr/exr_rows.h"

namespace {

// OpenEXR keeps what a chunk of DWA says of its channels for the next: where chunks are damaged, the order in which
// they are read tells what becomes of them.
bool is_dwa(tex::InputFile& file) {
    const Imf::Compression compression = tex::ExrReader(file).header().compression();
    return compression == Imf::DWAA_COMPRESSION || compression == Imf::DWAB_COMPRESSION;
}

// Some rows of a picture or level by themselves, which may begin and end in the middle of chunks and tiles. `choice`
// tells which.
void compare_some_rows(tex::RowSource& source, unsigned choice, bool any_order) {
    const auto whole = source.read_all();
    if (!whole) return any_order ? std::abort() : void();
    const auto [width, height] = source.extent();
    const int first = static_cast<int>(choice % static_cast<unsigned>(height));
    const int count = 1 + static_cast<int>(choice / 251 % static_cast<unsigned>(height - first));
    std::vector<std::byte> rows(source.row_bytes() * static_cast<std::size_t>((count + 3) / 4 * 4));
    if (!source.decode(first, count, rows.data())) return any_order ? std::abort() : void();
    tex::Image some = tex::make_image(source.extent(), source.names());
    source.store(rows.data(), first, first + count, some);
    for (std::size_t k = 0; k < some.planes.size(); ++k) {
        for (int j = first; j < first + count && any_order; ++j) {
            if (std::memcmp(some.planes[k].row(j), whole->planes[k].row(j),
                            sizeof(float) * static_cast<std::size_t>(width)) != 0)
                std::abort();
        }
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto* bytes = reinterpret_cast<const std::byte*>(data);
    auto file = tex::InputFile::from_memory("fuzz.exr", {bytes, bytes + size});
    if (!file) return 0;
    tex::ReadOptions options;
    options.max_texels = 1 << 16;
    const auto image = tex::read_all(tex::open_exr_rows(*file, options));
    if (!image && image.error().reason.empty()) std::abort();
    if (image && (image->extent().texels() > options.max_texels || image->names.size() != image->planes.size()))
        std::abort();
    const unsigned choice = size == 0 ? 0 : 251U * data[size / 2] + data[size - 1];
    if (image) {
        const auto rows = tex::open_exr_rows(*file, options);
        if (!rows) std::abort();
        compare_some_rows(**rows, choice, !is_dwa(*file));
    }
    const auto texture = tex::read_all(tex::open_exr_texture_rows(*file, options));
    if (!texture) return 0;
    if (!image) std::abort();
    const auto levels = tex::open_exr_texture_rows(*file, options);
    if (!levels) std::abort();
    for (std::size_t k = 1; k < levels->levels.size(); ++k)
        compare_some_rows(*levels->levels[k], choice, !is_dwa(*file));
    const auto again = tex::encode_exr(*texture);
    if (!again) std::abort();
    auto copy = tex::InputFile::from_memory("again.exr", *again);
    const auto same = tex::read_all(tex::open_exr_texture_rows(*copy, options));
    if (!same || same->levels.size() != texture->levels.size()) std::abort();
    for (std::size_t k = 0; k < same->levels.size(); ++k) {
        if (same->levels[k].bytes.size() != texture->levels[k].bytes.size()) std::abort();
    }
    return 0;
}
