// SPDX-License-Identifier: Apache-2.0
// A PNG of any bytes is read or refused; what is read has the extent, planes and bits that a PNG can have.

#include <cstdint>
#include <cstdlib>

#include "containers/png.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto* bytes = reinterpret_cast<const std::byte*>(data);
    auto file = tex::InputFile::from_memory("fuzz.png", {bytes, bytes + size});
    if (!file) return 0;
    tex::ReadOptions options;
    options.max_texels = 1 << 20;
    const auto image = tex::read_png(*file, options);
    if (!image) {
        if (image.error().reason.empty()) std::abort();
        return 0;
    }
    if (image->extent().texels() > options.max_texels || image->planes.empty() || image->planes.size() > 4) std::abort();
    if (image->names.size() != image->planes.size() || image->bits < 1 || image->bits > 16) std::abort();
    for (const auto& plane : image->planes) {
        for (int j = 0; j < plane.extent().height; ++j) {
            for (int i = 0; i < plane.extent().width; ++i) {
                if (!(plane.at(i, j) >= 0.0f && plane.at(i, j) <= 1.0f)) std::abort();
            }
        }
    }
    return 0;
}
