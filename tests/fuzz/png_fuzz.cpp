// SPDX-License-Identifier: Apache-2.0
// A PNG of any bytes is read or refused; what is read has the extent, planes and bits that a PNG can have, and is the
// same when its rows come a few at a time.
//
// libpng is not instrumented, so what it says of a file counts as coverage.

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <string>

#include "formats/png/png.h"
#include "formats/size_limits.h"
#include "fuzz/png_mutator.h"

namespace {

// A place for each reason why a file was refused, and for each kind of picture that was read.
[[gnu::section("__libfuzzer_extra_counters")]] std::uint8_t counters[512];

void count_refused(std::string reason) {
    reason.erase(0, reason.rfind(':') + 1);  // before it, the name of a chunk
    std::erase_if(reason, [](char c) { return c >= '0' && c <= '9'; });
    counters[std::hash<std::string>()(reason) % 256] = 1;
}

void count_read(const tex::Image& image, bool interlaced) {
    counters[256 + image.planes.size() * 64 - 64 + static_cast<std::size_t>(image.bits) * 2 + (interlaced ? 0 : 1)] = 1;
}

void compare_rows(const tex::Image& image, const tex::Image& again) {
    for (std::size_t c = 0; c < image.planes.size(); ++c) {
        for (int j = 0; j < image.extent().height; ++j) {
            const auto bytes = static_cast<std::size_t>(image.extent().width) * sizeof(float);
            if (std::memcmp(image.planes[c].row(j), again.planes[c].row(j), bytes) != 0) std::abort();
        }
    }
}

// Commands read some rows at a time: each must be what the whole picture has there.
void check_rows(tex::InputFile& file, const tex::ReadOptions& options, const tex::Image& image) {
    const auto rows = tex::open_png(file, options);
    if (!rows) std::abort();
    count_read(image, (*rows)->can_peek());  // only all rows of an interlaced picture are at hand
    constexpr int kRows = 3;
    tex::Image again = tex::make_image(image.extent(), image.names);
    std::vector<std::byte> bytes((*rows)->row_bytes() * (kRows + 1));
    for (int j = 0; j < image.extent().height; j += kRows) {
        const int count = std::min(kRows, image.extent().height - j);
        if (!(*rows)->decode(j, count, bytes.data())) std::abort();
        (*rows)->store(bytes.data(), j, j + count, again);
    }
    if (!(*rows)->finish()) std::abort();
    compare_rows(image, again);
}

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed) {
    return mutate_png(data, size, most, seed);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto* bytes = reinterpret_cast<const std::byte*>(data);
    auto file = tex::InputFile::from_memory("fuzz.png", {bytes, bytes + size});
    if (!file) return 0;
    tex::ReadOptions options;
    options.max_texels = 1 << 20;
    const auto image = tex::read_all(tex::open_png(*file, options));
    if (!image) {
        if (image.error().reason.empty()) std::abort();
        count_refused(image.error().reason);
        return 0;
    }
    if (image->extent().texels() > options.max_texels || image->planes.empty() || image->planes.size() > 4)
        std::abort();
    if (image->names.size() != image->planes.size() || image->bits < 1 || image->bits > 16) std::abort();
    for (const auto& plane : image->planes) {
        for (int j = 0; j < plane.extent().height; ++j) {
            for (int i = 0; i < plane.extent().width; ++i) {
                if (!(plane.at(i, j) >= 0.0f && plane.at(i, j) <= 1.0f)) std::abort();
            }
        }
    }
    auto again = tex::InputFile::from_memory("again.png", {bytes, bytes + size});
    if (!again) std::abort();
    check_rows(*again, options, *image);
    return 0;
}
