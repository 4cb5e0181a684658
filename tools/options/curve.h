// SPDX-License-Identifier: Apache-2.0
// curve.h: the option group for what rate-distortion optimisation costs and saves: which settings are tried.

#pragma once

#include <string>
#include <vector>

#include <tex/names.h>
#include <tex/pack_options.h>

#include "cli/command.h"

namespace tex::cli {

// The encodings that can be optimised.
inline constexpr Named<Encoding> kCurveFormatNames[] = {
    {Encoding::dxt5nm, "dxt5nm", "x in alpha, y in green of BC3"},
    {Encoding::bc5, "bc5", "x and y, each with 8 values"},
    {Encoding::bc5_snorm, "bc5-snorm", "BC5, signed"},
    {Encoding::eac_rg11, "eac-rg11", "11 bits, for phones"},
    {Encoding::eac_rg11_snorm, "eac-rg11-snorm", "the same, signed"},
};

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
