// SPDX-License-Identifier: Apache-2.0
// findings.h: what the rules look at, and where they put what they find.

#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <tex/check.h>

#include "checks/curl.h"
#include "checks/stored.h"
#include "checks/texel_counts.h"

namespace tex {

// A texture, its base level decoded, and what was measured of it. Without x or y in the swizzle only the file is
// checked.
struct Subject {
    const Texture& texture;
    const CheckOptions& options;
    const Execution& execution;
    Image base = {};
    Stored stored = {};
    bool has_vectors = false;
    bool constant = false;    // no channel varies
    bool sampled_ok = false;  // large and varied enough for statistics
    TexelCounts counts = {};
    Curl curl = {};
    YEvidence y = {};  // as far as the curl tells
};

class Findings {
public:
    explicit Findings(const CheckOptions& options) : options_(options) {}

    // Whether the rule is to be checked.
    [[nodiscard]] bool wants(std::string_view id) const;
    // Adds a finding of rule `id`, unless it is not wanted (then to a place that nobody reads).
    Finding& add(std::string_view id, std::string message);
    // The findings in order, without those that others explain; `explained` counts what was left out.
    std::vector<Finding> take(int& explained);

private:
    const CheckOptions& options_;
    std::vector<Finding> findings_;
    Finding ignored_;
};

// Numbers for messages, the same in every locale.
std::string decimal(double value, int decimals);
std::string percent(double share);  // "3.1 %", "0.004 %"
std::string extent_text(Extent extent);
std::string texel_text(int column, int row);  // "column 3, row 7"
std::string direction(YAxis y);

}  // namespace tex
