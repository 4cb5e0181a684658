// SPDX-License-Identifier: Apache-2.0
// findings.h: the data that the rules examine, and the place for their findings.

#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <tex/check.h>

#include "checks/curl.h"
#include "checks/stored.h"
#include "checks/texel_counts.h"
#include "checks/y_verdict.h"

namespace tex::inline v1 {

// A texture, its decoded base level, and measurements of it. If the swizzle has no x or no y, only the file is checked.
struct CheckContext {
    const Texture& texture;
    const CheckOptions& options;
    const Execution& execution;
    const std::string& file;  // its name
    Image base = {};
    Stored stored = {};
    bool has_vectors = false;
    bool constant = false;    // all channels are constant
    bool sampled_ok = false;  // large and varied enough for statistics
    std::optional<Background> background = {};
    TexelCounts counts = {};
    Curl curl = {};
    YEvidence y = {};  // what the curl shows, or the heights where they decide
    std::optional<MixedY> mixed_y = {};
    std::optional<PairEvidence> pair = {};
};

class Findings {
public:
    explicit Findings(const CheckOptions& options) : options_(options) {}

    // Whether the rule must be checked.
    [[nodiscard]] bool wants(std::string_view id) const;
    // Adds a finding of rule `id`. If that rule is not wanted, the result is a dummy that is not read.
    Finding& add(std::string_view id, std::string message);
    // The finding of this rule, or null.
    Finding* find(std::string_view id);
    // Returns the findings in order, without those that other findings explain; `explained` counts the omitted ones.
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

}  // namespace tex::inline v1
