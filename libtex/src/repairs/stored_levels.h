// SPDX-License-Identifier: Apache-2.0
// stored_levels.h: the levels of a texture as floats. Steps of a repair change them, and they are rounded once.

#pragma once

#include <vector>

#include <tex/pack.h>
#include <tex/types.h>

#include "checks/stored.h"

namespace tex::inline v1 {

struct StoredLevels {
    Texture head;               // what the file states, without levels
    std::vector<Image> levels;  // as decode() gives them
    bool is_signed = false;     // values are components; otherwise (n + 1) / 2
    bool keeps_blocks = false;  // an encoding writes the format with this layout and nothing beside it

    [[nodiscard]] Stored stored(int level) const {
        return {&levels[static_cast<std::size_t>(level)], head.swizzle, is_signed,
                format_info(head.format).has_blocks(), nullptr};
    }
    [[nodiscard]] StoredLevels clone() const;
};

// Decodes all levels. `swizzle` says what channels hold, and `has_extras` that they hold other data, too.
// Errors: out_of_memory, cancelled.
[[nodiscard]] Result<StoredLevels> decode_levels(const Texture& texture, const Swizzle& swizzle, bool has_extras,
                                                 const Execution& execution);

// Stores them in the format of the source, or in one without blocks if that cannot be written with this layout.
// Errors: out_of_memory, cancelled.
[[nodiscard]] Result<Texture> encode_levels(const StoredLevels& from, Effort effort, const Execution& execution);

}  // namespace tex::inline v1
