// SPDX-License-Identifier: Apache-2.0
// png_judge.h: compares how PNG files are read with how libpng reads them. Shared by unit tests and a fuzzer.

#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "formats/png/png.h"
#include "formats/png/png_libpng.h"
#include "formats/png/png_rows.h"

namespace tex {

// A decoded picture: what the source says about it, the bytes of its rows, and why it was refused, if it was.
struct Verdict {
    std::string refused;
    ErrorCode code = ErrorCode::io;
    Extent extent;
    std::vector<std::string> names;
    int bits = 0;
    std::string mark;
    std::vector<std::byte> rows;

    friend bool operator==(const Verdict&, const Verdict&) = default;
};

inline Verdict refusal(const Error& error) {
    Verdict verdict;
    verdict.refused = error.message();
    verdict.code = error.code;
    return verdict;
}

// Decodes `together` rows at a time.
inline Verdict verdict_of(const Result<std::unique_ptr<RowSource>>& source, int together) {
    if (!source) return refusal(source.error());
    RowSource& rows = **source;
    Verdict verdict{{}, ErrorCode::io, rows.extent(), rows.names(), rows.head().bits, rows.head().normal_mark, {}};
    const int height = rows.extent().height;
    verdict.rows.resize(rows.row_bytes() * static_cast<std::size_t>(height));
    for (int j = 0; j < height; j += together) {
        const int count = std::min(together, height - j);
        const Result<void> decoded =
            rows.decode(j, count, verdict.rows.data() + rows.row_bytes() * static_cast<std::size_t>(j));
        if (!decoded) return refusal(decoded.error());
    }
    if (const Result<void> ended = rows.finish(); !ended) return refusal(ended.error());
    return verdict;
}

inline ReadOptions judge_options() {
    ReadOptions options;
    options.max_texels = 1 << 24;
    return options;
}

inline InputFile judged_file(std::string_view bytes) {
    const auto* begin = reinterpret_cast<const std::byte*>(bytes.data());
    return std::move(*InputFile::from_memory("a.png", {begin, begin + bytes.size()}));
}

// Precondition: there is at least one byte.
inline Verdict our_verdict(std::string_view bytes, int together = 7) {
    InputFile file = judged_file(bytes);
    return verdict_of(open_png(file, judge_options()), together);
}

inline Verdict libpng_verdict(std::string_view bytes) {
    InputFile file = judged_file(bytes);
    return verdict_of(open_png_with_libpng(file, judge_options()), 1);
}

// Whether the file is read without libpng's help after the header.
inline bool is_plain_png(std::string_view bytes) {
    InputFile file = judged_file(bytes);
    LibpngReader header(file);
    if (!header.open(judge_options())) return false;
    const PngKind& kind = header.kind();
    const std::size_t row_bytes = static_cast<std::size_t>(header.extent().width * kind.expanded_channels()) *
                                  static_cast<std::size_t>(kind.expanded_bits() / 8);
    PlainPngRows rows(header.input(), header.first_length(), header.extent(), kind);
    std::vector<std::uint8_t> row(row_bytes);
    for (int j = 0; j < header.extent().height; ++j) {
        const Result<bool> plain = rows.decode(1, row_bytes, row.data());
        if (!plain || !*plain) return false;
    }
    const Result<bool> plain = rows.finish();
    return plain && *plain;
}

}  // namespace tex
