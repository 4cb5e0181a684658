// SPDX-License-Identifier: Apache-2.0

#include "checks/sign_rules.h"

#include <string>

#include <tex/unpack.h>

namespace tex {
namespace {

// Shares of texels outside the unit circle. Read with the wrong sign, flat texels lie in its corners.
constexpr double kWrongShare = 0.01;
constexpr double kRightShare = 0.002;

struct Twins {
    Format unorm, snorm;
};

// Formats of x and y alone, whose vectors show by themselves whether they can be right.
constexpr Twins kTwins[] = {
    {Format::bc5_unorm, Format::bc5_snorm},
    {Format::eac_rg11_unorm, Format::eac_rg11_snorm},
    {Format::rg8_unorm, Format::rg8_snorm},
    {Format::rg16_unorm, Format::rg16_snorm},
};

const Format* twin_of(Format format) {
    for (const Twins& twins : kTwins) {
        if (format == twins.unorm) return &twins.snorm;
        if (format == twins.snorm) return &twins.unorm;
    }
    return nullptr;
}

}  // namespace

Result<void> check_sign_rules(const Subject& subject, Findings& findings) {
    const Format* const twin = twin_of(subject.texture.format);
    const double share = subject.counts.share(Property::beyond_unit);
    if (twin == nullptr || !subject.has_vectors || share < kWrongShare || !findings.wants("N311")) return {};
    Texture other;
    other.format = *twin;
    other.levels = {subject.texture.levels.front()};
    const auto image = decode(other, 0, subject.execution);
    if (!image) return image.error();
    Stored stored = subject.stored;
    stored.image = &*image;
    stored.is_signed = !stored.is_signed;
    const auto counts = count_texels(stored, subject.execution);
    if (!counts) return counts.error();
    const double other_share = counts->share(Property::beyond_unit);
    if (other_share > kRightShare) return {};
    const auto name = [](Format format) { return std::string(name_of(kFormatNames, format)); };
    Finding& finding = findings.add("N311", "read as " + name(subject.texture.format) + ", " + percent(share) +
                                                " of the texels have x^2 + y^2 above 1; read as " + name(*twin) + ", " +
                                                (other_share > 0.0 ? percent(other_share) : "none"));
    finding.figure = share;
    finding.unit = "share";
    finding.confidence = 0.99;
    return {};
}

}  // namespace tex
