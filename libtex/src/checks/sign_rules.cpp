// SPDX-License-Identifier: Apache-2.0

#include "checks/sign_rules.h"

#include <optional>
#include <string>

#include <tex/pack.h>

namespace tex::inline v1 {
namespace {

// Shares of texels outside the unit circle. Read with the wrong sign, flat texels lie in its corners.
constexpr double kWrongShare = 0.01;
constexpr double kRightShare = 0.002;

// Returns a format of two channels with the other sign: vectors of x and y alone show by themselves
// whether they can be right.
std::optional<Format> twin_of(Format format) {
    FormatInfo info = format_info(format);
    if (info.channels != 2 || info.sample == SampleKind::floating) return std::nullopt;
    info.sample = info.sample == SampleKind::unorm ? SampleKind::snorm : SampleKind::unorm;
    for (const auto& row : kFormatNames) {
        if (format_info(row.value) == info) return row.value;
    }
    return std::nullopt;
}

}  // namespace

Result<void> check_sign_rules(const CheckContext& context, Findings& findings) {
    const std::optional<Format> twin = twin_of(context.texture.format);
    const double share = context.counts.share(Property::beyond_unit);
    if (!twin || !context.has_vectors || share < kWrongShare || !findings.wants("N311")) return {};
    Texture other;
    other.format = *twin;
    other.levels = {context.texture.levels.front()};
    const auto image = decode(other, 0, context.execution);
    if (!image) return image.error();
    Stored stored = context.stored;
    stored.image = &*image;
    stored.is_signed = !stored.is_signed;
    const auto counts = count_texels(stored, context.execution);
    if (!counts) return counts.error();
    const double other_share = counts->share(Property::beyond_unit);
    if (other_share > kRightShare) return {};
    const auto name = [](Format format) { return std::string(name_of(kFormatNames, format)); };
    Finding& finding = findings.add("N311", "read as " + name(context.texture.format) + ", " + percent(share) +
                                                " of the texels have x^2 + y^2 above 1; read as " + name(*twin) + ", " +
                                                (other_share > 0.0 ? percent(other_share) : "none"));
    finding.figure = share;
    finding.unit = "share";
    finding.confidence = 0.99;
    return {};
}

}  // namespace tex::inline v1
