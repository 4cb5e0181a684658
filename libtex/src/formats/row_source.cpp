// SPDX-License-Identifier: Apache-2.0

#include "formats/row_source.h"

#include <algorithm>

#include "formats/claims.h"
#include "formats/dds/dds.h"
#include "formats/exr/exr.h"
#include "formats/exr/exr_rows.h"
#include "formats/ktx2/ktx2.h"
#include "formats/png/png.h"
#include "formats/reader/reader_rows.h"

namespace tex {

Result<Image> RowSource::read_all() {
    Image image = make_image(extent(), names());
    image.sample = sample();
    image.bits = bits();
    image.normal_encoding = normal_encoding();
    std::vector<std::byte> rows(row_bytes() * static_cast<std::size_t>(rows_together()));
    for (int j = 0; j < extent().height; j += rows_together()) {
        const int count = std::min(rows_together(), extent().height - j);
        if (const Result<void> decoded = decode(j, count, rows.data()); !decoded) return decoded.error();
        store(rows.data(), j, j + count, image);
    }
    if (const Result<void> ended = finish(); !ended) return ended.error();
    return image;
}

Result<std::unique_ptr<RowSource>> open_rows(InputFile& file, const ReadOptions& options) {
    Result<std::unique_ptr<RowSource>> rows = std::unique_ptr<RowSource>();
    if (is_png(file.head())) {
        rows = open_png(file, options);
    } else if (is_exr(file.head())) {
        rows = open_exr_rows(file, options);
    } else if (!is_dds(file.head().data(), file.head().size()) && !is_ktx2(file.head().data(), file.head().size())) {
        rows = open_reader_rows(file, options);
    }
    if (!rows) return rows.error().of(file.path());
    return rows;
}

}  // namespace tex
