// SPDX-License-Identifier: Apache-2.0
// Elevation grids of any bytes are read or refused: an ESRI ASCII grid, or the header of a BIL, a zero byte, and its
// heights.

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <utility>
#include <vector>

#include "formats/asc/asc.h"
#include "formats/bil/bil_header.h"
#include "formats/file_values.h"

namespace {

void read_rows(tex::Result<std::unique_ptr<tex::RowSource>> rows, tex::FileValues values) {
    if (!rows) {
        if (rows.error().reason.empty()) std::abort();
        return;
    }
    const auto image = tex::read_all(tex::with_values(std::move(*rows), values));
    if (image ? image->planes.size() != 1 || image->names.size() != 1 : image.error().reason.empty()) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    tex::ReadOptions options;
    options.max_texels = std::int64_t{1} << 16;
    const auto* const bytes = reinterpret_cast<const std::byte*>(data);
    if (tex::may_be_asc({bytes, std::min<std::size_t>(size, tex::InputFile::kHeadBytes)})) {
        auto file = tex::InputFile::from_memory("fuzz.asc", {bytes, bytes + size});
        if (file) read_rows(tex::open_asc(*file, options), tex::FileValues::automatic);
        return 0;
    }
    const std::byte* const end = std::find(bytes, bytes + size, std::byte{0});
    const std::vector<std::byte> header(bytes, end);
    auto file = tex::InputFile::from_memory("fuzz.bil", {end, bytes + size});
    if (!file) return 0;
    for (const bool is_float : {false, true}) {
        const auto place = tex::read_bil_header(header, "fuzz.hdr", is_float, *file->size(), options);
        if (!place && place.error().reason.empty()) std::abort();
        if (!place || place->end() > *file->size()) continue;
        read_rows(tex::open_raw_rows(*file, *place), tex::FileValues::unit);
        read_rows(tex::open_raw_rows(*file, *place), tex::FileValues::stored);
    }
    return 0;
}
