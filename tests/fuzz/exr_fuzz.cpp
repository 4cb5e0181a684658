// SPDX-License-Identifier: Apache-2.0
// An EXR of any bytes is read or refused, as a picture and as a texture; a texture that is read can be written and read again.

#include <cstdint>
#include <cstdlib>

#include "containers/exr.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto* bytes = reinterpret_cast<const std::byte*>(data);
    auto file = tex::InputFile::from_memory("fuzz.exr", {bytes, bytes + size});
    if (!file) return 0;
    tex::ReadOptions options;
    options.max_texels = 1 << 16;
    const auto image = tex::read_exr(*file, options);
    if (!image && image.error().reason.empty()) std::abort();
    if (image && (image->extent().texels() > options.max_texels || image->names.size() != image->planes.size())) std::abort();
    const auto texture = tex::read_exr_texture(*file, options);
    if (!texture) return 0;
    if (!image) std::abort();
    const auto again = tex::encode_exr(*texture);
    if (!again) std::abort();
    auto copy = tex::InputFile::from_memory("again.exr", *again);
    const auto same = tex::read_exr_texture(*copy, options);
    if (!same || same->levels.size() != texture->levels.size()) std::abort();
    for (std::size_t k = 0; k < same->levels.size(); ++k) {
        if (same->levels[k].bytes.size() != texture->levels[k].bytes.size()) std::abort();
    }
    return 0;
}
