// SPDX-License-Identifier: Apache-2.0
// any_order.h: what must be true of every picture whose rows can be read in any order.

#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <span>
#include <vector>

#include "formats/row_source.h"
#include "formats/size_limits.h"

using OpenRows = tex::Result<std::unique_ptr<tex::RowSource>> (*)(tex::InputFile&, const tex::ReadOptions&);

inline void check_image(const tex::Image& image, const tex::ReadOptions& options) {
    if (image.extent().texels() > options.max_texels || image.planes.empty() || image.planes.size() > 4) std::abort();
    if (image.names.size() != image.planes.size() || image.bits < 1 || image.bits > 16) std::abort();
    for (const auto& plane : image.planes) {
        for (int j = 0; j < plane.extent().height; ++j) {
            for (int i = 0; i < plane.extent().width; ++i) {
                if (!(plane.at(i, j) >= 0.0f && plane.at(i, j) <= 1.0f)) std::abort();
            }
        }
    }
}

// Strips of some rows, from the last to the first, must be what the whole picture has there.
inline void check_strips(tex::RowSource& rows, const tex::Image& image) {
    constexpr int kRows = 3;
    if (!rows.is_random()) std::abort();
    tex::Image again = tex::make_image(image.extent(), image.names);
    std::vector<std::byte> bytes(rows.row_bytes() * kRows);
    for (int end = image.extent().height; end > 0; end -= kRows) {
        const int first = std::max(end - kRows, 0);
        if (!rows.decode(first, end - first, bytes.data())) std::abort();
        rows.store(bytes.data(), first, end, again);
    }
    const auto row_bytes = static_cast<std::size_t>(image.extent().width) * sizeof(float);
    for (std::size_t c = 0; c < image.planes.size(); ++c) {
        for (int j = 0; j < image.extent().height; ++j) {
            if (std::memcmp(image.planes[c].row(j), again.planes[c].row(j), row_bytes) != 0) std::abort();
        }
    }
}

inline void expect_same_in_any_order(std::span<const std::byte> bytes, OpenRows open) {
    auto file = tex::InputFile::from_memory("fuzz", {bytes.begin(), bytes.end()});
    if (!file) return;
    tex::ReadOptions options;
    options.max_texels = 1 << 18;
    const auto image = tex::read_all(open(*file, options));
    if (!image) {
        if (image.error().reason.empty()) std::abort();
        return;
    }
    check_image(*image, options);
    const auto rows = open(*file, options);
    if (!rows) std::abort();
    check_strips(**rows, *image);
}
