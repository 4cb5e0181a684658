// SPDX-License-Identifier: Apache-2.0
// findings.h: check reports as text and as JSON.

#pragma once

#include <cstdint>
#include <string>

#include <tex/check.h>

#include "cli/json.h"

namespace tex::cli {

// The file, and the map if it is one of a model: "car.glb: Paint: paint_n.png".
[[nodiscard]] std::string title_of(const CheckReport& report);

// "Green points ...: green points down instead of up."
[[nodiscard]] std::string statement_of(const Finding& finding);

// One line for each finding, with its fix below: "maps/a.dds: error N401 wrong-y: Green points ...: green points down
// instead of up".
[[nodiscard]] std::string findings_text(const CheckReport& report, const Requirements& require);

// The result of the comparison with the height map, even if it is not a finding; empty if there is no height map.
[[nodiscard]] std::string pair_text(const CheckReport& report);

// How the occlusion follows the normals, even if it is not a finding; empty if there is none.
[[nodiscard]] std::string occlusion_text(const CheckReport& report);

// Which way green points in the map, as the texels show.
[[nodiscard]] std::string y_text(const CheckReport& report);

// How well the map fits its mesh, even if it is not a finding; empty if there is no mesh or no seam.
[[nodiscard]] std::string seams_text(const CheckReport& report);

// The report, as --json prints it.
[[nodiscard]] Json findings_json(const CheckReport& report, const Requirements& require);

// All rules in a table, and one rule in detail.
[[nodiscard]] std::string rules_text();
[[nodiscard]] std::string rule_text(const Rule& rule);

// Counts of files and of findings by severity, for the last line.
struct CheckTotals {
    int files = 0, unreadable = 0, known = 0;
    int by_severity[3] = {};
    bool fails = false;         // a finding makes the command fail
    std::string left_out = {};  // FileOptions::left_out()

    // `its_known`: the number of findings that a baseline removed from the report. Files are counted by the caller.
    void add(const CheckReport& report, int its_known);
    [[nodiscard]] std::string text() const;
};

}  // namespace tex::cli
