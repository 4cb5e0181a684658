// SPDX-License-Identifier: Apache-2.0
// layout_finder.h: decides how to read the rows of a texture if that depends on its texels. A layout is assumed first,
// and judged when all texels have been seen.

#pragma once

#include <optional>

#include <tex/source.h>

#include "formats/texture_rows.h"
#include "rows/swizzle_evidence.h"
#include "rows/unpack_rows.h"

namespace tex {

struct Layout {
    Swizzle swizzle = {};
    bool is_unsigned = true;  // values are (n + 1) / 2
};

// What is known about a layout.
struct KnownLayout {
    std::optional<Swizzle> swizzle;
    std::optional<bool> is_unsigned;
};

class LayoutFinder {
public:
    // `known` is what earlier texels have shown.
    LayoutFinder(const TextureRows& texture, const SourceOptions& options, const KnownLayout& known);

    // The assumed layout.
    [[nodiscard]] const Layout& layout() const { return layout_; }
    [[nodiscard]] bool depends_on_texels() const { return evidence_ || weighs_; }

    // Adds the next row of the base level: the values of each channel of the format, then null.
    void add_row(const float* const (&channels)[4]);

    // To be called after the last row. Returns what the texels say, if that differs from what was assumed. If both
    // assumptions are wrong, it returns the swizzle first, because the other assumption depends on it.
    [[nodiscard]] std::optional<KnownLayout> correction() const;

private:
    const SourceOptions& options_;
    KnownLayout known_;
    Layout layout_;
    std::optional<SwizzleEvidence> evidence_;
    bool weighs_ = false;
    Sources sources_;
    RangeEvidence range_;
    const int width_;
    int row_ = 0;
};

}  // namespace tex
