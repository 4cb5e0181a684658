// SPDX-License-Identifier: Apache-2.0

#include "options/curve.h"

#include <algorithm>
#include <functional>

#include <fmt/format.h>

#include "cli/text.h"
#include "cli/usage_error.h"
#include "fields/pack_fields.h"
#include "tasks/collisions.h"

namespace tex::cli {

void CurveOptions::add(Command& command) {
    constexpr Range kAngle{0.0, 180.0, false};
    command.group("Curve");
    command
        .option("--rdo-means", "LIST",
                "pack A with each --rdo-mean in LIST, such as 0,0.1,0.3, and print bytes and angles; 0 is without",
                [this](const std::string& text) {
                    for (const std::string& mean : split(text, ','))
                        means_.push_back(parse_float(mean, range_of(&RdoOptions::mean)));
                    if (std::adjacent_find(means_.begin(), means_.end(), std::greater_equal<>()) != means_.end())
                        throw UsageError("its angles must rise");
                })
        .often(1, "pack A with each --rdo-mean in LIST, such as 0,0.1,0.3");
    command.choice(format_, "--format", "F", kEncodingNames, "the encoding", can_optimise);
    command.number(rdo_.max, "--rdo-max", "DEG", kAngle, "no texel's angle grows beyond DEG").preset =
        "four times the mean";
    command.number(rdo_.window, "--rdo-window", "BYTES", range_of(&RdoOptions::window),
                   "how far back to look for what a block can copy");
    command.output_file(plot_, "--plot", "draw the curve, as SVG");
}

std::vector<PackOptions> CurveOptions::settings() const {
    std::vector<PackOptions> settings;
    for (const float mean : means_) {
        PackOptions options{format_};
        options.rdo = rdo_;
        options.rdo.mean = mean;
        settings.push_back(options);
    }
    return settings;
}

void CurveOptions::check(const Command& command) const {
    if (!is_asked()) {
        const std::vector<std::string> more = command.given_of({"--format", "--rdo-max", "--rdo-window", "--plot"});
        if (!more.empty()) throw UsageError(fmt::format("{} needs --rdo-means", more.front()));
        return;
    }
    if (command.inputs().size() != 1) throw UsageError("--rdo-means takes one file: A");
    const std::vector<std::string> other = command.given_of(
        {"--y-b", "--level", "--mesh", "--max-mean", "--max-p999", "--max", "--heatmap", "--report", "--depfile"});
    if (!other.empty()) throw UsageError(fmt::format("{} and --rdo-means contradict each other", other.front()));
    if (plot_.empty()) return;
    std::vector<std::string> read = command.inputs();
    read.insert(read.end(), command.argument_files().begin(), command.argument_files().end());
    check_document({"--plot", plot_}, read, {});
}

}  // namespace tex::cli
