// SPDX-License-Identifier: Apache-2.0
// repairs.h: what repair() did, as text and as JSON.

#pragma once

#include <string>
#include <string_view>

#include <tex/repair.h>

#include "cli/json.h"

namespace tex::cli {

// One line for each step and for each error and warning that is left: "a.png: N302 srgb-encoded: decode with the sRGB
// curve (safe), 12.3 degrees". Empty for a map without either.
[[nodiscard]] std::string repairs_text(const std::string& name, const Repaired& repaired);

// What a manifest says to repair a fault that is left: " (likely = true repairs it)"; or nothing.
[[nodiscard]] std::string_view manifest_words(const FaultLeft& fault);

// The doubt that stays where N220 inverts blue back.
[[nodiscard]] std::string inversion_words(bool is_in_model);

// Whether the picture holds something else than normals, which no repair changes.
[[nodiscard]] bool holds_no_normals(const Repaired& repaired);
// The line for such a picture of a folder, which nobody has named.
[[nodiscard]] std::string left_out_text(const std::string& name, const Repaired& repaired);

// What --json prints of it, with notes, too.
[[nodiscard]] Json repairs_json(const Repaired& repaired);

// Counts of maps, for the last line.
struct RepairTotals {
    int maps = 0, repaired = 0, refused = 0, kept = 0, whole = 0;  // kept: with faults that stay
    int likely = 0;                                                // of those that are repaired: by a likely step
    int left_out = 0;                                              // of folders: pictures that hold no normals

    void add(const Repaired& of);
    void add(const RepairTotals& of);
    void leave_out() { ++left_out; }
    [[nodiscard]] std::string text(bool is_dry_run) const;
};

}  // namespace tex::cli
