// SPDX-License-Identifier: Apache-2.0
// removal.h: removes an output that no rule makes any more, if it is what it was.

#pragma once

#include <string>

#include "tree/sha256.h"

namespace tex::cli {

enum class Removal {
    removed,
    missing,
    changed,  // another file, or a link, is in its place or on the way
    failed,   // errno says why
};

// Removes the file `name` of `folder` if it is a regular file whose contents have this sum. `folder` may be a link; no
// link below it is followed. If `is_dry_run` is set, says what it would do.
[[nodiscard]] Removal remove_output(const std::string& folder, const std::string& name, const Digest& digest,
                                    bool is_dry_run);

}  // namespace tex::cli
