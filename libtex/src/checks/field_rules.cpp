// SPDX-License-Identifier: Apache-2.0

#include "checks/field_rules.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "checks/centre.h"
#include "checks/thresholds.h"
#include "checks/turn.h"

namespace tex::inline v1 {
namespace {

// Between the changes of p and q across their own directions. After a turn by the angle a, bumps without a preferred
// direction have cos(2 a) / (1 + 2 sin(a)^2) left: 0.76 after 15 degrees.
constexpr double kSoundCorrelation = 0.9;
constexpr double kMostBehind = 0.05;   // share of texels that face away: more is object space
constexpr double kLeastRms = 0.03;     // of changes over two texels: rounding to 8 bits gives 0.0045
constexpr double kMostShared = 0.5;    // see TurnScale::shared()
constexpr double kLeastOther = 0.015;  // of the energy of p in that of q or the other way: less is one direction
constexpr double kClearAxis = 0.5;     // strength of an axis that counts, and by how many degrees such axes may differ:
constexpr double kMostApart = 15.0;    // turned maps of which scales show more than rounding differ by at most 11
constexpr int kLeastSideForTurn = 64;  // smaller maps, as pixel art, have axes by chance
constexpr double kMostTurned = 75.0;   // a quarter turn is the same as exchanged channels: N308

bool shows_more_than_rounding(const TurnScale& scale) { return scale.rms() >= kLeastRms; }

// Slopes that all lie along one axis, as those of corrugated sheet do: JPEG then makes an axis of what is left.
bool has_one_direction(const TurnScale& scale) {
    const auto [less, more] = std::minmax(scale.p_square, scale.q_square);
    return scale.shared() > kMostShared || less < kLeastOther * more;
}

// The scale with the clearest axis, if a picture that was turned explains all scales: each has slopes of two
// directions, and clear axes agree.
const TurnScale* clearest_scale(const Turn& turn) {
    const TurnScale* best = nullptr;
    for (const TurnScale& scale : turn.scale) {
        if (!shows_more_than_rounding(scale)) continue;
        if (has_one_direction(scale)) return nullptr;
        if (best == nullptr || scale.clearest().strength() > best->clearest().strength()) best = &scale;
    }
    if (best == nullptr) return nullptr;
    for (const TurnScale& scale : turn.scale) {
        if (!shows_more_than_rounding(scale) || scale.clearest().strength() < kClearAxis) continue;
        const double apart = std::abs(scale.clearest().angle() - best->clearest().angle());
        if (std::min(apart, 180.0 - apart) > kMostApart) return nullptr;
    }
    return best;
}

void check_turned(const CheckContext& context, const Turn& turn, Findings& findings) {
    const auto [width, height] = context.stored.extent();
    if (std::min(width, height) < kLeastSideForTurn) return;
    // Colours whose hue was turned no longer centre on the middle; those of a picture that was turned do.
    constexpr double kMostOff = 0.05;
    if (measure_centre(context.stored, context.background ? &*context.background : nullptr).distance(0.5) > kMostOff)
        return;
    const TurnScale* const scale = clearest_scale(turn);
    if (scale == nullptr || scale->clearest().strength() < thresholds::kTurnStrength) return;
    const double angle = scale->clearest().angle();
    if (std::abs(angle) < thresholds::kTurnAngle || std::abs(angle) > kMostTurned) return;
    Finding& finding = findings.add("N309", "the curl is that of a picture turned by " + decimal(std::abs(angle), 0) +
                                                " degrees " + (angle > 0.0 ? "counterclockwise" : "clockwise") +
                                                " (strength " + decimal(scale->clearest().strength(), 2) + ")");
    finding.figure = angle;
    finding.unit = "degrees";
    finding.confidence = 0.95;
}

void check_noise(const CheckContext& context, const Turn& turn, Findings& findings) {
    double share = 1.0, correlation = 0.0;
    for (int k = 0; k < Turn::kScales; ++k) {
        // Fine noise hides a surface that larger scales show; where these show nothing, they do not count.
        if (turn.scale[k].rms() < kLeastRms && k > 0) continue;
        if (turn.scale[k].rms() < kLeastRms) return;
        share = std::min(share, turn.scale[k].curl_share());
        correlation = std::max(correlation, std::abs(context.curl.scale[k].correlation()));
    }
    if (share < thresholds::kNoiseCurl || correlation > thresholds::kNoiseCorrelation) return;
    Finding& finding = findings.add("N310", percent(share) + " of the changes of slope are curl; noise has 50 %");
    finding.figure = share;
    finding.unit = "share";
    finding.confidence = 0.95;
}

}  // namespace

Result<void> check_field_rules(const CheckContext& context, Findings& findings) {
    if (!context.sampled_ok || context.curl.usable < kLeastUsable) return {};
    if (context.counts.share(Property::z_behind) > kMostBehind) return {};
    if (std::abs(context.curl.correlation) > kSoundCorrelation) return {};  // as in most maps: it saves time
    if (!findings.wants("N309") && !findings.wants("N310")) return {};
    const auto turn = measure_turn(context.stored, context.execution);
    if (!turn) return turn.error();
    check_turned(context, *turn, findings);
    check_noise(context, *turn, findings);
    return {};
}

}  // namespace tex::inline v1
