// SPDX-License-Identifier: Apache-2.0

#include "checks/extra_rules.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

#include "checks/chroma.h"
#include "checks/curl.h"
#include "checks/layout_fit.h"
#include "rows/z_evidence.h"

namespace tex::inline v1 {
namespace {

constexpr int kAlpha = 3;
constexpr std::size_t kBlue = 2;
constexpr double kMostLean = 0.25;     // of x or y in the mean: more is no normal map, whatever blue holds
constexpr double kBelow = 0.0005;      // share of texels whose z is below 0
constexpr double kZFollows = 0.5;      // correlation of z with rebuilt z: z of JPEGs of low quality has more
constexpr double kMostBeyond = 0.005;  // share of texels with x^2 + y^2 above 1: likewise

const char* letter(int channel) { return channel == 0 ? "R" : channel == 1 ? "G" : "B"; }

// Calls `row` with each row of two channels until it returns false, which is the result.
template <class Row>
bool all_rows(const Image& image, int channel, int other, Row&& row) {
    const Plane<float>&a = image.planes[static_cast<std::size_t>(channel)],
          &b = image.planes[static_cast<std::size_t>(other)];
    for (int j = 0; j < a.extent().height; ++j) {
        if (!row(a.row(j), b.row(j))) return false;
    }
    return true;
}

// The channel that A repeats, or -1.
int repeated_by_alpha(const CheckContext& context) {
    const int width = context.stored.extent().width;
    for (int channel = 0; channel < kAlpha; ++channel) {
        const auto is_same = [width](const float* a, const float* b) { return std::equal(a, a + width, b); };
        if (all_rows(context.base, channel, kAlpha, is_same)) return channel;
    }
    return -1;
}

void check_free_alpha(const CheckContext& context, Findings& findings) {
    const Component held = context.stored.swizzle[kAlpha];
    if (context.base.planes.size() <= kAlpha || held == Component::x || held == Component::y || held == Component::z)
        return;
    if (!(context.counts.high[kAlpha] > context.counts.low[kAlpha])) return;
    if (const int channel = repeated_by_alpha(context); channel >= 0) {
        findings.add("N218", std::string("A equals ") + letter(channel) + " in every texel");
        return;
    }
    const int width = context.stored.extent().width;
    std::int64_t zeros = 0;
    const auto is_mask = [&](const float* a, const float*) {
        zeros += std::count(a, a + width, 0.0f);
        return std::all_of(a, a + width, [](float value) { return value == 0.0f || value == 1.0f; });
    };
    if (!all_rows(context.base, kAlpha, kAlpha, is_mask)) return;
    const double share = static_cast<double>(zeros) / static_cast<double>(context.stored.extent().texels());
    Finding& finding = findings.add("N217", "A is 0 in " + percent(share) + " of the texels and 1 in all others");
    finding.figure = share;
    finding.unit = "share";
}

// Whether the slopes of a surface are those with a rebuilt z. Vectors of uneven length do not follow x and y either,
// but their slopes do not depend on their length.
Result<bool> has_better_slopes_without_z(const CheckContext& context) {
    constexpr double kBetter = 0.02;  // of the correlation of curl
    Stored without = context.stored;
    for (Component& held : without.swizzle) held = held == Component::z ? Component::other : held;
    const auto curl = measure_curl(without, context.execution);
    if (!curl) return curl.error();
    return std::abs(curl->correlation) > std::abs(context.curl.correlation) + kBetter;
}

// Data in alpha, too, are the layout of LabPBR, and meant.
void add_other_data(const CheckContext& context, Findings& findings) {
    const TexelCounts& counts = context.counts;
    Finding& finding = findings.add(
        "N219", "blue does not follow x and y as z does: " + decimal(static_cast<double>(counts.low[kBlue]), 2) +
                    " to " + decimal(static_cast<double>(counts.high[kBlue]), 2));
    if (context.base.planes.size() <= kAlpha || counts.high[kAlpha] <= counts.low[kAlpha]) return;
    findings.rate(finding, Severity::note);
    if (std::abs(context.curl.correlation) < kLeastCorrelation)  // x and y themselves may be elsewhere
        finding.message += fitting_layout_text(context.stored);
}

// Whether blue follows x and y, as z does.
Result<void> check_stored_z(const CheckContext& context, Findings& findings) {
    const Stored& stored = context.stored;
    const TexelCounts& counts = context.counts;
    if (context.kind == Kind::two_components && context.sampled_ok) add_other_data(context, findings);
    const bool is_floating = format_info(context.texture.format).sample == SampleKind::floating;
    if (!context.sampled_ok || context.options.any_length || is_floating || stored.swizzle[kBlue] != Component::z ||
        counts.high[kBlue] - counts.low[kBlue] <= (stored.in_blocks ? kBlockError : 0.0f))
        return {};
    if (std::max(std::abs(counts.mean_x), std::abs(counts.mean_y)) > kMostLean) return {};
    const Plane<float>&x = context.base.planes[static_cast<std::size_t>(stored.channel(Component::x))],
          &y = context.base.planes[static_cast<std::size_t>(stored.channel(Component::y))],
          &z = context.base.planes[kBlue];
    ZEvidence evidence;
    for (int j = 0; j < stored.extent().height; j += z_step(stored.extent().height))
        evidence.add_row(x.row(j), y.row(j), z.row(j), !stored.is_signed, stored.extent().width);
    if (evidence.beyond() > kMostBeyond) return {};
    Result<bool> is_sure = evidence.is_surely_something_else();
    if (!*is_sure && evidence.is_something_else() && evidence.correlation() < kZFollows) {
        // z of uneven vectors is never below 0.
        is_sure = counts.share(Property::z_below) > kBelow ? Result<bool>(true) : has_better_slopes_without_z(context);
    }
    if (!is_sure) return is_sure.error();
    // What chroma at half resolution has lost does not follow z, either.
    const Background* const background = context.background ? &*context.background : nullptr;
    if (*is_sure && !measure_chroma(stored, background).is_halved()) add_other_data(context, findings);
    return {};
}

}  // namespace

Result<void> check_extra_rules(const CheckContext& context, Findings& findings) {
    if (!context.has_vectors) return {};
    check_free_alpha(context, findings);
    return check_stored_z(context, findings);
}

}  // namespace tex::inline v1
