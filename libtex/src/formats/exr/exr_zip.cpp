// SPDX-License-Identifier: Apache-2.0

#include "formats/exr/exr_zip.h"

#include <libdeflate.h>

#include <new>

#include "formats/exr/exr.h"
#include "kernels/zip_bytes.h"

namespace tex::inline v1 {
namespace {

// Chunks are a little smaller than those of OpenEXR (zlib's level 4), and take half of the time (measured on normals of
// smooth and of rough heights).
constexpr int kDeflateLevel = 4;

}  // namespace

const char* inflater_version() { return LIBDEFLATE_VERSION_STRING; }

Unzipper::Unzipper() : inflater_(libdeflate_alloc_decompressor(), libdeflate_free_decompressor) {
    if (!inflater_) throw std::bad_alloc();
}

std::span<const std::byte> Unzipper::texels(std::span<const std::byte> chunk, std::size_t wanted, std::size_t most) {
    if (chunk.size() >= wanted) return chunk.first(wanted);  // stored uncompressed, if compression does not help
    inflated_.resize(most);
    std::size_t size = 0;
    const libdeflate_result result =
        libdeflate_zlib_decompress(inflater_.get(), chunk.data(), chunk.size(), inflated_.data(), most, &size);
    if (result != LIBDEFLATE_SUCCESS || size < wanted) return {};
    texels_.resize(most);
    restore_zip_bytes(inflated_.data(), size, texels_.data());
    return std::span(texels_).first(wanted);
}

Zipper::Zipper() : deflater_(libdeflate_alloc_compressor(kDeflateLevel), libdeflate_free_compressor) {
    if (!deflater_) throw std::bad_alloc();
}

std::span<const std::byte> Zipper::chunk() {
    const std::size_t count = texels.size();
    differences_.resize(count);
    predict_zip_bytes(texels.data(), count, differences_.data());
    // The texels give their room to the chunk: for wide pictures, every buffer is large.
    const std::size_t size =
        libdeflate_zlib_compress(deflater_.get(), differences_.data(), count, texels.data(), count - 1);
    if (size > 0) return std::span(texels).first(size);
    // A chunk that is not smaller than its texels is stored uncompressed. Readers know it by its size.
    restore_zip_bytes(differences_.data(), count, texels.data());
    return texels;
}

}  // namespace tex::inline v1
