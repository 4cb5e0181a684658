// SPDX-License-Identifier: Apache-2.0

#include "checks/convention_rules.h"

#include <cmath>
#include <string>
#include <utility>

#include "checks/y_verdict.h"

namespace tex::inline v1 {
namespace {

constexpr double kHeightsConfidence = 0.95;

void check_mixed(const CheckContext& context, Findings& findings) {
    if (!context.mixed_y) return;
    Finding& finding = findings.add("N402", context.mixed_y->text());
    finding.figure = context.mixed_y->share();
    finding.unit = "share";
    finding.confidence = context.y.confidence;
    finding.regions = context.mixed_y->regions;
}

// The first limit that the evidence misses.
std::string undecided_by(const Curl& curl) {
    if (curl.usable < kLeastUsable)
        return "only " + percent(curl.usable) + " of them hold a usable normal, of at least " + percent(kLeastUsable);
    const CurlSums& sums = curl.scale[curl.best_scale];
    if (!sums.changes_across() && sums.px_square * sums.qy_square > 0.0)
        return "the slopes change along the axes alone, as those of lines and bevels do";
    if (std::abs(curl.correlation) < kLeastCorrelation)
        return "the correlation is nearer to 0 than " + decimal(kLeastCorrelation, 1);
    constexpr double kClear = 0.5;  // of maps that are too small to be sure of anything
    const std::string why = std::abs(curl.correlation) > kClear ? "there are too few texels to be sure"
                                                                : "parts of the map contradict each other";
    return why + " (confidence " + decimal(curl.confidence, 3) + " of at least " + decimal(kLeastConfidence, 2) + ")";
}

// What the number is, because a small one is no certainty.
std::string curl_text(const CheckContext& context) {
    return " (correlation " + decimal(context.y.correlation, 2) + ", from -1, down, to 1, up; " +
           decimal(kLeastCorrelation, 1) + " is enough)";
}

// What contradicts `wanted`: the texels show that one of red and green is mirrored, and only heights show which.
std::string contradiction(const CheckContext& context, YAxis wanted, const std::string& says) {
    const YAxis shown = opposite_of(wanted);
    const auto& pair = context.pair;
    if (!pair || !pair->decides()) {
        return "either green points " + direction(shown) + says + direction(wanted) +
               ", or red points left instead of right; from the slopes alone, the two look the same" +
               curl_text(context);
    }
    const std::string fit = " (correlation " + decimal(pair->correlation, 2) + " with them, as far as white is high)";
    if (pair->strength < 0.0) return "red points left instead of right, as the heights show" + fit;
    return "green points " + direction(shown) + says + direction(wanted) + ", as the heights show" + fit;
}

}  // namespace

void check_convention_rules(const CheckContext& context, Findings& findings) {
    const auto& require = context.options.require;
    if (!context.sampled_ok) {
        if (require.y && context.has_vectors && !context.texture.y_known)
            findings.add("N403", "the picture is too small or too flat to show it");
        return;
    }
    check_mixed(context, findings);
    const auto add = [&](std::string_view id, std::string message) {
        Finding& finding = findings.add(id, std::move(message));
        const bool by_heights = context.pair && context.pair->decides();
        finding.figure = by_heights ? context.pair->correlation : context.y.correlation;
        finding.unit = "correlation";
        finding.confidence = by_heights ? kHeightsConfidence : context.y.confidence;
    };
    if (require.y && !context.y.y)
        add("N403", "the texels do not show it: " + undecided_by(context.curl) + curl_text(context));
    if (!context.y.y) return;
    if (require.y && *context.y.y != *require.y) add("N401", contradiction(context, *require.y, " instead of "));
    if (context.texture.y_known && *context.y.y != context.texture.y_axis)
        add("N404", contradiction(context, context.texture.y_axis, ", the file says "));
}

}  // namespace tex::inline v1
