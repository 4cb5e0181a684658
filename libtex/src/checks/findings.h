// SPDX-License-Identifier: Apache-2.0
// findings.h: the data that the rules examine, and the place for their findings.

#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <tex/check.h>

#include "checks/curl.h"
#include "checks/kind.h"
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
    Kind kind = Kind::normals;
    KindMeasure kind_measure = {};  // without texels if lengths do not matter, or values are components
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
    // Gives a finding another severity than its rule's, unless the options name one for its rule.
    void rate(Finding& finding, Severity severity) const;
    // The finding of this rule, or null.
    Finding* find(std::string_view id);
    // Returns the findings in order, without those that other findings explain; `explained` counts the omitted ones.
    std::vector<Finding> take(int& explained);

private:
    const CheckOptions& options_;
    std::vector<Finding> findings_;
    Finding ignored_;
};

// Marks the first affected texel of the base level.
void set_texel(Finding& finding, int column, int row);
// Adds a finding that says how many texels have a property.
Finding& add_counted(const CheckContext& context, Findings& findings, std::string_view id, Property property,
                     const std::string& what);

// Numbers for messages, the same in every locale.
std::string decimal(double value, int decimals);
std::string percent(double share);  // "3.1 %", "0.004 %"
std::string extent_text(Extent extent);
std::string texel_text(int column, int row);  // "column 3, row 7"
std::string direction(YAxis y);

}  // namespace tex::inline v1
