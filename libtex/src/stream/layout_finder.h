// SPDX-License-Identifier: Apache-2.0
// layout_finder.h: how the rows of a texture are to be read, where its texels decide that: assumed first, judged when
// all of them have been seen.

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

// What is known of a layout.
struct KnownLayout {
    std::optional<Swizzle> swizzle;
    std::optional<bool> is_unsigned;
};

class LayoutFinder {
public:
    // `known` was learnt from the texels before.
    LayoutFinder(const TextureRows& texture, const SourceOptions& options, const KnownLayout& known);

    // That which is assumed.
    [[nodiscard]] const Layout& layout() const { return layout_; }
    [[nodiscard]] bool depends_on_texels() const { return evidence_ || weighs_; }

    // The next row of the base level: the values of the channels of the format, null behind the last one.
    void add_row(const float* const (&channels)[4]);

    // After the last row: what the texels say, where it is not what was assumed. Of two wrong assumptions the swizzle's
    // is told first, as the other one rests on it.
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
