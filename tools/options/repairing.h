// SPDX-License-Identifier: Apache-2.0
// repairing.h: the option group of repairs: which faults, and what decides where texels do not.

#pragma once

#include <optional>
#include <string>

#include <tex/height.h>
#include <tex/repair.h>

#include "cli/command.h"
#include "options/normals.h"

namespace tex::cli {

// --material, --likely, --only, --skip, --height, --mirrored, --turned, --bumpiness, --swizzle, --keep-length.
class RepairingOptions {
public:
    void add(Command& command);

    [[nodiscard]] const std::string& material() const { return material_; }        // or empty
    [[nodiscard]] const std::string& height_file() const { return height_file_; }  // or empty
    [[nodiscard]] bool names_mirrored() const { return options_.mirrored.has_value(); }
    [[nodiscard]] bool bakes() const { return options_.bumpiness.has_value(); }

    // Reads the heights, if they are given. Errors: those of read_image() and height_field().
    [[nodiscard]] Result<void> read_heights(const ReadOptions& read);

    // `y` is the direction that is required. The options point to the heights.
    [[nodiscard]] RepairOptions options(std::optional<YAxis> y, Effort effort) const;

private:
    std::string material_, height_file_;
    std::optional<HeightField> height_;
    RepairOptions options_;
    std::optional<LengthIn> length_in_;
};

}  // namespace tex::cli
