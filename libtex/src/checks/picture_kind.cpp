// SPDX-License-Identifier: Apache-2.0

#include "checks/picture_kind.h"

#include <algorithm>

#include <tex/format.h>

#include "checks/thresholds.h"

namespace tex::inline v1 {
namespace {

// Confidence from a measure that separates two kinds at `limit`: 0.5 there, 1 at `sure` and beyond.
double confidence_of(double measure, double limit, double sure) {
    return 0.5 + 0.5 * std::clamp((measure - limit) / (sure - limit), 0.0, 1.0);
}

// The best of the readings that undo what may have happened to a map.
double most_unit(const KindMeasure& measure) {
    double most = 0.0;
    for (const KindMeasure::Vectors& vectors : measure.reading) most = std::max(most, vectors.unit);
    return most;
}

}  // namespace

void set_kind(const CheckContext& context, PictureKind found, CheckReport& report) {
    const KindMeasure& measure = context.kind_measure;
    constexpr double kCertain = 1.0, kLikely = 0.9, kUnmeasured = 0.75;
    constexpr double kUsualUnit = 0.95;  // of normal maps
    report.kind = found;
    switch (found) {
        case PictureKind::grey: {
            // Nobody needs more than 8 bits for roughness or occlusion.
            const bool is_deep = format_info(context.texture.format).bits > 8;
            if (is_deep) report.kind = PictureKind::heights;
            report.kind_confidence = is_deep ? kLikely : kCertain;
            return;
        }
        case PictureKind::colors:
            report.kind_confidence = confidence_of(1.0 - measure.as(Reading::as_stored).unit,
                                                   1.0 - thresholds::kUnitShare, thresholds::kUnitShare);
            return;
        case PictureKind::normals:
        case PictureKind::object_space: {
            // Where x or y stand for z, vectors point away, too: no other space is needed.
            const auto& findings = report.findings;
            if (std::any_of(findings.begin(), findings.end(), [](const Finding& f) { return f.rule->id == "N308"; }))
                report.kind = PictureKind::normals;
            const bool is_measured = measure.texels > 0 && context.stored.has_z();
            const double unit =
                is_measured ? confidence_of(most_unit(measure), thresholds::kUnitShare, kUsualUnit) : kUnmeasured;
            report.kind_confidence = std::max(unit, context.y.y ? context.y.confidence : 0.5);
            return;
        }
        case PictureKind::constant: report.kind_confidence = kCertain; return;
        case PictureKind::data: report.kind_confidence = kUnmeasured; return;
        case PictureKind::heights: report.kind_confidence = kLikely; return;
        case PictureKind::unknown: return;
    }
}

}  // namespace tex::inline v1
