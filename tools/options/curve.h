// SPDX-License-Identifier: Apache-2.0
// curve.h: the option group for what rate-distortion optimisation costs and saves: which settings are tried.

#pragma once

#include <string>
#include <vector>

#include <tex/pack.h>

#include "cli/command.h"

namespace tex::cli {

// --rdo-means, --format, --rdo-max, --rdo-window, --plot.
class CurveOptions {
public:
    void add(Command& command);

    [[nodiscard]] bool is_asked() const { return !means_.empty(); }
    // One for each setting. The first one is what the others are compared with.
    [[nodiscard]] std::vector<PackOptions> settings() const;
    [[nodiscard]] const std::string& plot() const { return plot_; }  // a path, or empty

    // Throws UsageError.
    void check(const Command& command) const;

private:
    std::vector<float> means_;  // degrees, rising
    Encoding format_ = Encoding::bc5;
    RdoOptions rdo_;
    std::string plot_;
};

}  // namespace tex::cli
