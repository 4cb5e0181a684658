// SPDX-License-Identifier: Apache-2.0

#include "checks/kind_rules.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <tex/format.h>

#include "checks/byte_heights.h"
#include "checks/centre.h"
#include "checks/layout_fit.h"
#include "checks/lengths.h"

namespace tex::inline v1 {
namespace {

constexpr double kGreyEverywhere = 0.999;
constexpr double kGreyMostly = 0.95;  // JPEG adds a little colour to grey
constexpr double kBehindShare = 0.05;
constexpr double kColorShare = 0.9;
constexpr double kExtremeShare = 0.9;
constexpr float kExtreme = 8.0f / 255.0f;  // of a stored channel: as near to 0 or 1 as metalness is
// For x: occlusion is near 1, or an unused 0. Flat maps that went through the sRGB curve have 0.57.
constexpr double kFarMean = 0.7;
constexpr double kFarOffUnit = 0.25;  // of the length of a constant vector

void add_share(Findings& findings, std::string_view id, std::string message, double share) {
    Finding& finding = findings.add(id, std::move(message));
    finding.figure = share;
    finding.unit = "share";
}

bool is_constant(const Plane<float>& channel) {
    const float first = channel.at(0, 0);
    for (int j = 0; j < channel.extent().height; ++j) {
        const float* const row = channel.row(j);
        if (!std::all_of(row, row + channel.extent().width, [first](float v) { return v == first; })) return false;
    }
    return true;
}

// The share of values that are nearly 0 or 1.
double extreme_share(const Plane<float>& channel) {
    const Extent extent = channel.extent();
    std::int64_t count = 0;
    for (int j = 0; j < extent.height; ++j) {
        const float* const row = channel.row(j);
        for (int i = 0; i < extent.width; ++i) count += row[i] <= kExtreme || row[i] >= 1.0f - kExtreme ? 1 : 0;
    }
    return static_cast<double>(count) / static_cast<double>(extent.texels());
}

// Occlusion in red, roughness in green and metalness in blue: blue is 0 or 1, as no z is, and red is far from the 0.5
// of an upright vector.
bool check_surface_data(const CheckContext& context, Findings& findings) {
    const Stored& stored = context.stored;
    if (stored.swizzle[0] != Component::x || stored.swizzle[1] != Component::y || stored.swizzle[2] != Component::z)
        return false;
    const double off = context.counts.share(Property::off_length), mean = context.counts.mean_x;
    if (off <= kColorShare || std::abs(mean) <= kFarMean) return false;
    // Red and green equally dark, but not 0 as where there is no occlusion, beside a blue of 1: normals whose levels
    // were stretched.
    constexpr double kAlike = 0.05, kUnused = -0.99, kOne = 0.9;
    const KindMeasure::Vectors& v = context.kind_measure.as(Reading::as_stored);
    if (v.x < 0.0 && v.x > kUnused && std::abs(v.x - v.y) < kAlike && v.z > kOne) return false;
    const double share = extreme_share(context.base.planes[2]);
    if (share < kExtremeShare) return false;
    add_share(findings, "N216",
              "blue is nearly 0 or 1 in " + percent(share) + " of the texels, red is " + decimal(0.5 + 0.5 * mean, 2) +
                  " in the mean, and " + percent(off) + " are off unit length" + fitting_layout_text(stored),
              share);
    return true;
}

void add_grey(Findings& findings, double share, const std::string& more = {}) {
    add_share(findings, "N210", "R, G and B are equal in " + percent(share) + " of the texels" + more, share);
}

FoundKind check_no_map(const CheckContext& context, Findings& findings) {
    const KindMeasure& measure = context.kind_measure;
    const double grey = context.counts.share(Property::grey);
    if (context.stored.has_z() && grey > kGreyEverywhere) {
        add_grey(findings, grey);
        return {PictureKind::grey};
    }
    if (!context.stored.has_z() && measure.grey > kGreyEverywhere) {
        add_grey(findings, measure.grey,
                 context.stored.channel(Component::x) == 3 ? ", and A is no x beside them" : "");
        return {PictureKind::grey};
    }
    if (check_surface_data(context, findings)) return {PictureKind::data};
    if (context.stored.is_signed) {
        add_counted(context, findings, "N214", Property::off_length,
                    " are off unit length by more than two codes, and neither x nor y is below 0 anywhere");
        return {PictureKind::colors};
    }
    const double unit = measure.as(Reading::as_stored).unit;
    const FormatInfo format = format_info(context.texture.format);
    const auto bytes =
        format.bits == 8 && !format.has_blocks() ? byte_heights(context.base) : std::optional<HeightChannel>();
    if (bytes) {
        add_share(findings, "N214",
                  "R, G and B are the bytes of heights, as in map tiles: " +
                      std::string(name_of(kHeightChannelNames, *bytes)),
                  unit);
        return {PictureKind::heights, bytes};
    }
    if (context.stored.has_z() && measure.grey > kGreyMostly && measure.correlation > kGreyMostly) {
        add_share(findings, "N210",
                  "R, G and B differ by at most 6 codes in " + percent(measure.grey) + " of the texels", measure.grey);
        return {PictureKind::grey};
    }
    add_share(findings, "N214", evidence_text(measure, context.stored.has_z()) + fitting_layout_text(context.stored),
              unit);
    return {PictureKind::colors};
}

// All texels are the same, and no vector.
void check_constant(const CheckContext& context, Findings& findings) {
    if (context.options.any_length) return;
    // The curve of sRGB makes one colour of a flat map, whose length alone is not far off.
    constexpr float kCode = 1.5f / 255.0f;
    const auto& low = context.counts.low;
    for (const bool is_light : {true, false}) {
        const auto middle = static_cast<float>(is_light ? srgb_encoded(0.5) : srgb_decoded(0.5));
        const auto is_middle = [&](float c) { return std::abs(c - middle) < kCode; };
        if (context.stored.is_signed || !is_middle(low[0]) || !is_middle(low[1]) || low[2] < 1.0f - kCode) continue;
        Finding& finding =
            findings.add(is_light ? "N302" : "N301", "every texel has R and G of " +
                                                         decimal(255.0 * static_cast<double>(low[0]), 0) +
                                                         " of 255, which the curve makes of 128");
        finding.figure = static_cast<double>(low[0]);
        finding.unit = "of full scale";
        finding.confidence = 0.9;
        return;
    }
    const double length = context.counts.mean_length;
    if (std::abs(length - 1.0) <= kFarOffUnit || length < static_cast<double>(kNullLength)) return;
    Finding& finding =
        findings.add("N214", "every texel has the same colour, whose length as a vector is " + decimal(length, 2));
    finding.figure = length;
    finding.unit = "ratio";
}

// How far z is from what x and y imply, in the mean, if it is blue and if it is 2 blue - 1. The sign of the latter does
// not count: bevels may lean beyond the vertical.
struct FitOfZ {
    double as_stored = 0.0, from_zero = 0.0;
};

FitOfZ fit_of_z(const Stored& stored) {
    double as_stored = 0.0, from_zero = 0.0, count = 0.0;
    visit_samples(stored, [&](const double(&c)[3], int, int) {
        const double x = 2.0 * c[0] - 1.0, y = 2.0 * c[1] - 1.0, square = 1.0 - x * x - y * y;
        if (!(square > 0.0)) return;
        const double z = std::sqrt(square);
        as_stored += std::abs(std::abs(2.0 * c[2] - 1.0) - z);
        from_zero += std::abs(c[2] - z);
        count += 1.0;
    });
    return count > 0.0 ? FitOfZ{as_stored / count, from_zero / count} : FitOfZ();
}

// Whether blue is that z, and 2 blue - 1 is not. Maps of unit vectors that are nearly flat show it, too.
bool follows_from_zero(const FitOfZ& fit) {
    constexpr double kLead = 6.0, kLeastError = 1.5 / 127.5;
    constexpr double kClearLead = 10.0, kLeastClearError = 1.0 / 127.5;  // nearly flat
    if (fit.as_stored > kLeastError) return fit.from_zero * kLead < fit.as_stored;
    return fit.as_stored > kLeastClearError && fit.from_zero * kClearLead < fit.as_stored;
}

// Blue ranges from 0 to 1 as z of the upper half of the sphere does. Without z below 0, the vectors must be much
// better: those of strong JPEG are a little better, too. And some vectors must point straight out: where none does, all
// of them may be too short.
bool holds_z_from_zero(const CheckContext& context) {
    const KindMeasure& m = context.kind_measure;
    constexpr double kUnit = 0.95, kBetter = 0.05, kMuchBetter = 0.25, kZRelated = 0.8;
    constexpr float kUprightBlue = 0.97f;
    // Channels that were stretched to their ends one by one (auto-level) fit worse: 8 codes and more.
    constexpr double kMostError = 5.0 / 255.0;
    const int blue = context.stored.channel(Component::z);
    if (blue < 0 || !(context.counts.high[static_cast<std::size_t>(blue)] > kUprightBlue)) return false;
    const FitOfZ fit = fit_of_z(context.stored);
    if (fit.from_zero > kMostError) return false;
    if (context.sampled_ok && follows_from_zero(fit)) return true;
    const double unit = m.as(Reading::z_from_zero).unit, better = unit - m.as(Reading::as_stored).unit;
    const bool is_better = m.behind > kBehindShare ? better > kBetter : context.sampled_ok && better > kMuchBetter;
    return m.texels > 0 && unit > kUnit && is_better && m.z_correlation > kZRelated;
}

// z below 0 in many texels: why.
PictureKind check_behind(const CheckContext& context, Findings& findings) {
    const double share = context.counts.share(Property::z_behind);
    const KindMeasure& m = context.kind_measure;
    const bool from_zero = holds_z_from_zero(context);
    if (share <= kBehindShare && !from_zero) return PictureKind::normals;
    const KindMeasure::Vectors& v = m.as(Reading::as_stored);
    constexpr double kCentred = 0.35, kInvertedShare = 0.9, kDown = -0.6, kUprightShare = 0.25, kRare = 0.1;
    if (m.texels > 0 && share > kInvertedShare && v.off_centre() < kCentred && v.z < kDown) {
        add_counted(context, findings, "N220", Property::z_behind, " point into the surface (z below -0.1)");
    } else if (from_zero) {
        // Rounding makes 0.6 codes where vectors are steep. What else was changed has moved x and y, too.
        constexpr double kMostOfRounding = 1.5;
        const double off = 255.0 * fit_of_z(context.stored).from_zero;
        Finding& finding = findings.add("N221", percent(m.as(Reading::z_from_zero).unit) +
                                                    " of the vectors have about unit length if z is blue, and " +
                                                    percent(v.unit) + " if it is 2 blue - 1");
        finding.figure = m.as(Reading::z_from_zero).unit;
        finding.unit = "share";
        if (off > kMostOfRounding) {
            finding.confidence = 0.9;
            finding.message += "; z then still differs by " + decimal(off, 1) +
                               " codes from what x and y imply, so that more may have been changed, as by automatic "
                               "levels";
        }
    } else if (m.texels == 0 || m.upright < kUprightShare || m.inverted > kRare * m.upright) {
        add_counted(context, findings, "N213", Property::z_behind, " point away from the surface (z below -0.1)");
        // Object-space maps hold unit vectors, although rounded or compressed ones.
        if (context.options.any_length || context.counts.share(Property::off_length) <= kColorShare)
            return PictureKind::object_space;
        add_counted(context, findings, "N214", Property::off_length, " are off unit length by more than two codes");
        return PictureKind::colors;
    }
    return PictureKind::normals;
}

}  // namespace

FoundKind check_kind_rules(const CheckContext& context, Findings& findings) {
    switch (context.kind) {
        case Kind::no_map: return check_no_map(context, findings);
        case Kind::x_lost:
            findings.add("N222", "R and B are constant, and there is no alpha: G holds y, and nothing holds x");
            return {PictureKind::normals};
        case Kind::x_ray: findings.add("N223", "A, B and G are unit vectors as x, y and z"); break;
        case Kind::normals:
        case Kind::two_components: break;
    }
    if (!context.has_vectors) {
        const auto& planes = context.base.planes;
        return {std::all_of(planes.begin(), planes.end(), is_constant) ? PictureKind::constant : PictureKind::grey};
    }
    if (context.stored.has_z()) {
        // Components and lengths that do not matter leave this to be told: floats of heights.
        const double grey = context.counts.share(Property::grey);
        if (grey > kGreyEverywhere && !context.constant) {
            add_grey(findings, grey);
            check_behind(context, findings);
            return {PictureKind::grey};
        }
        if (!context.constant) return {check_behind(context, findings)};
        check_constant(context, findings);
    }
    return {context.constant ? PictureKind::constant : PictureKind::normals};
}

}  // namespace tex::inline v1
