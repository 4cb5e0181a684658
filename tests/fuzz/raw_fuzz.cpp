// SPDX-License-Identifier: Apache-2.0
// Bytes without a header, with any layout, are read or refused. The layout is the first line of the input.

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

#include "formats/raw/raw.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::uint8_t* const end = data + size;
    const std::uint8_t* const line = std::find(data, end, '\n');
    tex::ReadOptions options;
    options.max_texels = std::int64_t{1} << 20;
    options.raw.assign(data, line);
    if (line == end || options.raw.empty()) return 0;
    const auto* const rest = reinterpret_cast<const std::byte*>(line + 1);
    auto file = tex::InputFile::from_memory("fuzz.raw", {rest, reinterpret_cast<const std::byte*>(end)});
    if (!file) return 0;
    for (const tex::FileValues values : {tex::FileValues::unit, tex::FileValues::stored}) {
        options.values = values;
        const auto image = tex::read_all(tex::open_rows(*file, options));
        if (image && image->planes.size() != 1) std::abort();
    }
    return 0;
}
