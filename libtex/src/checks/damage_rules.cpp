// SPDX-License-Identifier: Apache-2.0

#include "checks/damage_rules.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <iterator>
#include <optional>
#include <string>
#include <vector>

#include "checks/centre.h"
#include "checks/chroma.h"
#include "checks/curve_rules.h"
#include "checks/few_values.h"
#include "checks/grid.h"
#include "checks/jpeg.h"
#include "checks/lattice.h"
#include "checks/lengths.h"
#include "checks/scaled.h"
#include "checks/seam.h"
#include "checks/thresholds.h"
#include "checks/tone.h"
#include "checks/wall.h"
#include "rows/border_slope.h"
#include "rows/codecs.h"
#include "threads/parallel.h"

namespace tex::inline v1 {
namespace {

// Thresholds that follow from the nature of the damage and need no fitting. The fitted ones are in thresholds.h.
constexpr double kBlockRatio = 2.0;
constexpr double kBlockExcess = 2.0 / 255.0;  // half a code of DXT5nm's green (6 bits): the effect of rounding alone
constexpr double kJpegElsewhere = 0.5;        // of the strength at the blocks of a JPEG
constexpr double kJpegLead = 1.05;            // grid_lead(8): of maps enlarged by 2 or 4 about 1
constexpr int kLeastTurnedSide = 64;          // smaller maps, as pixel art, seem exchanged by chance
constexpr int kLatticeTeeth = 6;
constexpr double kLatticeUneven = 0.25;
constexpr double kAboveAlphaShare = 0.002;
constexpr double kAlphaCorrelation = 0.9;
constexpr double kHalfAlphaShare = 0.01;
constexpr double kExchangedMean = 0.4;
// 131 of 315 real maps are found once x and y are exchanged: four of them with less than 0.3, 2.3 times and more what
// they have as stored. A smooth cone on one with flat facets has 0.25, 1.9 times.
constexpr double kExchangedClearly = 0.3, kExchangedRatio = 2.2;
constexpr double kExchangedZ = 0.2;

// What takes long to measure. A member has its default value if no rule asks for it.
struct Traces {
    Centre centre;
    Seam seam;
    double grid_ratio = 0.0;  // of the format's own blocks
    JpegTrace jpeg;           // in a format without blocks
    Lattice lattice;
    Enlargement enlargement;
};

// Measures all at once, on several threads. Each measure is the work of one of them.
Result<void> measure_traces(const CheckContext& context, bool wants_seam, Traces& traces) {
    const Stored& stored = context.stored;
    std::vector<std::function<void()>> measures;
    if (context.sampled_ok) {
        measures.emplace_back([&] {
            if (const FormatRow& row = format_row(context.texture.format); row.info.has_blocks()) {
                if (row.codec->has_grid) traces.grid_ratio = grid_ratio(stored, row.info.block.width);
                return;
            }
            traces.enlargement = find_enlargement(stored);
            if (traces.enlargement.factor == 1) traces.jpeg = measure_jpeg(stored);
        });
        measures.emplace_back([&] { traces.lattice = measure_lattice(stored); });
    }
    if (!stored.is_signed)
        measures.emplace_back(
            [&] { traces.centre = measure_centre(stored, context.background ? &*context.background : nullptr); });
    if (wants_seam) measures.emplace_back([&] { traces.seam = find_seam(stored, thresholds::kSeamRatio); });
    const Execution silent = context.execution.quiet();
    return parallel_for(silent, static_cast<int>(measures.size()), 1,
                        [&](int k, int) { measures[static_cast<std::size_t>(k)](); });
}

// Whether x and y centre on half of alpha where it is neither 0 nor 1. In LabPBR, blue is occlusion and may follow the
// heights in alpha, but x and y centre on 0.5 everywhere.
bool are_x_and_y_multiplied(const Stored& stored) {
    double from_half = 0.0, from_alpha = 0.0;
    const Plane<float>& alpha = stored.image->planes[3];
    for (const Component component : {Component::x, Component::y}) {
        const Plane<float>& plane = stored.image->planes[static_cast<std::size_t>(stored.channel(component))];
        for (int j = 0; j < alpha.extent().height; ++j) {
            for (int i = 0; i < alpha.extent().width; ++i) {
                const float a = alpha.at(i, j), c = plane.at(i, j);
                if (!(a > 0.1f && a < 0.9f)) continue;
                from_half += std::abs(static_cast<double>(c) - 0.5);
                from_alpha += std::abs(static_cast<double>(c) - 0.5 * static_cast<double>(a));
            }
        }
    }
    return from_alpha < from_half;
}

void check_alpha(const CheckContext& context, Findings& findings) {
    const TexelCounts& counts = context.counts;
    const Stored& stored = context.stored;
    const bool straight_possible =
        stored.has_z() && !stored.is_signed && stored.image->planes.size() == 4 && stored.channel(Component::x) != 3;
    if (!straight_possible || counts.high[3] - counts.low[3] < 0.1f) return;
    if (counts.share(Property::above_alpha) > kAboveAlphaShare || counts.alpha_correlation < kAlphaCorrelation) return;
    // A mask with black outside it proves nothing, but half-transparent texels do.
    const Plane<float>& alpha = stored.image->planes[3];
    double half = 0.0;
    for (int j = 0; j < alpha.extent().height; ++j) {
        for (int i = 0; i < alpha.extent().width; ++i)
            half += alpha.at(i, j) > 0.1f && alpha.at(i, j) < 0.9f ? 1.0 : 0.0;
    }
    if (half < kHalfAlphaShare * static_cast<double>(counts.all)) return;
    if (!are_x_and_y_multiplied(stored)) return;
    const double as_stored = length_error(stored, [](double c, int, int) { return c; });
    const double restored = length_error(stored, [&](double c, int i, int j) {
        const double a = alpha.at(i, j);
        return a < 0.1 ? 0.85 : c / a;  // a vector of length 1.2: as good as unknown
    });
    if (restored >= as_stored) return;
    Finding& finding = findings.add("N303", "R, G and B never exceed alpha and follow it (correlation " +
                                                decimal(counts.alpha_correlation, 2) + ")");
    finding.figure = counts.alpha_correlation;
    finding.unit = "correlation";
    finding.confidence = 0.99;
}

// What happened to a map whose x and y fit each other only if exchanged: with y up, slopes that were exchanged agree,
// and those of a picture turned by 90 degrees disagree; with y down it is the other way round.
std::string exchange_text(const CheckContext& context) {
    const std::string exchanged = "x and y are exchanged";
    const std::string turned = "the picture was turned by 90 degrees, but its vectors were not";
    const bool agree = context.curl.exchanged > 0.0;
    std::optional<YAxis> y = context.options.require.y;
    if (!y && context.texture.y_known) y = context.texture.y_axis;
    if (y) return (*y == YAxis::up) == agree ? exchanged : turned;
    return (agree ? exchanged : turned) + ", if green points up; if it points down, " + (agree ? turned : exchanged);
}

void check_exchanged(const CheckContext& context, Findings& findings) {
    const TexelCounts& counts = context.counts;
    if (context.stored.has_z() && std::max(counts.mean_x, counts.mean_y) > kExchangedMean &&
        std::abs(counts.mean_z) < kExchangedZ) {
        Finding& finding = findings.add(
            "N308", counts.mean_x > counts.mean_y ? "the channel of x holds z" : "the channel of y holds z");
        finding.figure = std::max(counts.mean_x, counts.mean_y);
        finding.unit = "component";
        finding.confidence = 0.99;
        return;
    }
    if (std::min(context.stored.extent().width, context.stored.extent().height) < kLeastTurnedSide) return;
    const double as_stored = std::abs(context.curl.correlation), exchanged = std::abs(context.curl.exchanged);
    const bool behind = counts.share(Property::z_behind) > 0.05;
    if (behind || exchanged < as_stored + kExchangedLead || exchanged < kExchangedLeast) return;
    // What smooth normals leave on the facets of a low mesh is no slope of heights, and fits neither way.
    if (exchanged < kExchangedClearly && exchanged < kExchangedRatio * as_stored) return;
    if (context.curl.exchanged_confidence < kExchangedConfidence) return;
    // The slopes of most surfaces change more along their own axis than across it, so they must do so after the
    // exchange. A bowl, whose slopes do not change across at all, looks exactly like a saddle with exchanged channels.
    const CurlSums& sums = context.curl.scale[context.curl.best_scale];
    if (sums.p_square * sums.q_square < kExchangedEnergy * sums.px_square * sums.qy_square) return;
    if (diagonal_share(context.stored) > kMostDiagonal) return;
    Finding& finding = findings.add("N308", exchange_text(context) + " (correlation " + decimal(exchanged, 2) +
                                                " exchanged, " + decimal(as_stored, 2) + " as stored)");
    finding.figure = exchanged;
    finding.unit = "correlation";
    finding.confidence = context.curl.exchanged_confidence;
    finding.turned_y = context.curl.exchanged > 0.0 ? YAxis::down : YAxis::up;
}

// Whether the trace comes from aligned blocks. Maps of few distinct values have it at every offset, and few blocks
// agree by chance: a bake of 64x64 had 0.35, 52 crops of 64x64 and 128x128 without a JPEG stayed silent, and JPEGs of
// them had 0.70 and more.
bool stands_out(const JpegTrace& trace, const Stored& stored) {
    const double blocks = static_cast<double>(stored.extent().texels()) / 64.0;
    if (trace.strength < 0.3 + 1.6 / std::sqrt(blocks)) return false;
    constexpr int kOffsets[] = {1, 3, 4};
    return std::none_of(std::begin(kOffsets), std::end(kOffsets), [&](int offset) {
        return measure_jpeg(stored, offset).strength > kJpegElsewhere * trace.strength;
    });
}

// Inside of blocks there may be next to no steps.
std::string times(double ratio) {
    return ratio > 1000.0 ? "more than 1000 times" : decimal(ratio, ratio < 10.0 ? 2 : 0) + " times";
}

void check_blocks(const CheckContext& context, const Traces& traces, Findings& findings) {
    const auto add = [&](std::string_view id, std::string message, double figure, std::string_view unit) {
        Finding& finding = findings.add(id, std::move(message));
        finding.figure = figure;
        finding.unit = unit;
        finding.confidence = 0.95;
    };
    if (const FormatInfo info = format_info(context.texture.format); info.has_blocks()) {
        const double ratio = traces.grid_ratio;
        if (ratio > kBlockRatio && grid_excess(context.stored, info.block.width) > kBlockExcess) {
            add("N306", "steps between 4x4 blocks are " + times(ratio) + " those inside", ratio, "ratio");
        }
        return;
    }
    // An enlarged picture has a grid, too, but no codec has touched it since. Of a nearly flat map, a strong JPEG
    // leaves one value in each of its blocks, which are twice as large in chroma.
    const Enlargement& scaled = traces.enlargement;
    const bool is_jpeg = container_of(context.file) == Container::jpeg && scaled.factor % 8 == 0 && !scaled.is_linear;
    if (scaled.factor > 1 && !is_jpeg) {
        add("N312",
            (scaled.is_linear ? "linear interpolation between every " : "the same value in squares of ") +
                (scaled.is_linear ? std::to_string(scaled.factor) + " texels"
                                  : extent_text({scaled.factor, scaled.factor}) + " texels"),
            scaled.factor, "ratio");
        return;
    }
    // The first trace found counts, because blocks of 8x8 are also blocks of 4x4.
    const JpegTrace& jpeg = traces.jpeg;
    if (jpeg.weight() > thresholds::kJpegTrace && stands_out(jpeg, context.stored)) {
        add("N304",
            "the transform of 8x8 blocks is quantised as by JPEG of quality " + decimal(jpeg.quality(), 0) +
                " (strength " + decimal(jpeg.strength, 2) + ")",
            jpeg.quality(), "quality");
        return;
    }
    const double palette = palette_share(context.stored);
    if (palette > thresholds::kPaletteShare) {
        add("N306", percent(palette) + " of the 4x4 blocks hold a palette of three or four colours", palette, "share");
        return;
    }
    const double ratio = grid_ratio(context.stored, 8);
    if (ratio > thresholds::kJpegRatio && grid_lead(context.stored, 8) > kJpegLead)
        add("N304", "steps between 8x8 blocks are " + times(ratio) + " those inside", ratio, "ratio");
}

// Colours at half resolution. As bumps of two texels and less are then those of luma, x and y are too small and follow
// each other in them.
void check_chroma(const CheckContext& context, Findings& findings) {
    constexpr double kLeastLost = 2.0;  // codes: a degree or so
    const FormatInfo info = format_info(context.texture.format);
    if (info.has_blocks() || info.bits != 8 || context.kind != Kind::normals || !findings.wants("N316")) return;
    const ChromaDetail detail = measure_chroma(context.stored, context.background ? &*context.background : nullptr);
    if (!detail.is_halved() || detail.lost() < kLeastLost) return;
    Finding& finding =
        findings.add("N316", "from texel to texel, chroma (Cr) changes by " + decimal(detail.chroma / detail.luma, 2) +
                                 " of what luma does (in intact maps, by 0.7 or more); it has lost about " +
                                 decimal(detail.lost(), 0) + " codes of 8 bits, rms");
    finding.figure = detail.lost();
    finding.unit = "codes";
    finding.confidence = 0.95;
}

void check_palette(const CheckContext& context, const Lattice& lattice, Findings& findings) {
    if (!findings.wants("N317")) return;
    // Heights of 8 bits have slopes on a lattice, and few colours from the beginning.
    constexpr double kSureLattice = 0.95;
    if (lattice.strength >= kSureLattice && findings.find("N305") != nullptr) return;
    const Palette palette = find_palette(context.stored);
    if (palette.colors == 0) return;
    Finding& finding =
        findings.add("N317", std::to_string(palette.colors) + " colours in all; " + percent(palette.share) +
                                 " of the texels are 3 codes or more from the nearest other colour, " +
                                 decimal(palette.degrees, 1) + " degrees in the mean");
    finding.figure = palette.degrees;
    finding.unit = "degrees";
    finding.confidence = 0.95;
}

// Pictures of 8 bits alone: what was rounded so and stored with more bits has the same values.
void check_posterised(const CheckContext& context, const Lattice& lattice, Findings& findings) {
    const FormatInfo info = format_info(context.texture.format);
    const bool is_8_bits = !info.has_blocks() && info.sample == SampleKind::unorm && info.bits == 8;
    if (!is_8_bits || !(findings.wants("N315") || findings.wants("N317"))) return;
    const int levels = few_levels(context.stored);
    if (levels == 0) {
        check_palette(context, lattice, findings);
        return;
    }
    if (!findings.wants("N315")) return;
    Finding& finding = findings.add("N315", "x and y take " + std::to_string(levels) +
                                                " values at most, which lie 4 codes or more from each other");
    finding.figure = levels;
    finding.unit = "values";
    finding.confidence = 0.95;
}

void check_banding(const Lattice& lattice, Findings& findings) {
    if (lattice.strength < thresholds::kLatticeStrength || lattice.teeth < kLatticeTeeth) return;
    if (lattice.uneven < kLatticeUneven) return;
    Finding& finding = findings.add("N305", "slopes are multiples of " + decimal(lattice.step, 4) + " (strength " +
                                                decimal(std::min(1.0, lattice.strength), 2) + ")");
    finding.figure = lattice.step;
    finding.unit = "slope";
    finding.confidence = 0.95;
}

void check_seam(const CheckContext& context, const Seam& seam, Findings& findings) {
    const SeamSteps* const steps = seam.worst_standing_out();
    if (steps == nullptr || steps->ratio() < thresholds::kSeamRatio) return;
    const auto codes = [](double step) { return decimal(127.5 * step, 1); };
    const Extent extent = context.stored.extent();
    Finding& finding = findings.add(
        "N307", "the mean step from the " +
                    std::string(steps->of_columns ? "last column to the first" : "last row to the first") + " is " +
                    codes(steps->border) + " codes of 8 bits; inside, 98 % of the steps between " +
                    (steps->of_columns ? "columns" : "rows") + " are below " + codes(steps->usual) +
                    ", and the largest is " + codes(steps->largest));
    finding.figure = steps->ratio();
    finding.unit = "ratio";
    finding.confidence = 0.95;
    finding.regions = {steps->of_columns ? Region{0, extent.width - 1, 0, 1, extent.height}
                                         : Region{0, 0, extent.height - 1, extent.width, 1}};
}

// Heights that do not repeat, baked as if they did, leave no step between opposite borders, but a wall along them.
void check_wall(const CheckContext& context, Findings& findings) {
    if (!findings.wants("N307") || findings.find("N307") != nullptr) return;
    const double ratio = find_wall(context.stored);
    if (ratio <= BorderSlope::kWall) return;
    Finding& finding = findings.add("N307", "a wall runs along the border, " + decimal(ratio, 1) +
                                                " times as steep as any column or row inside: heights that do not "
                                                "repeat were baked as if they did");
    finding.figure = ratio;
    finding.unit = "ratio";
    finding.confidence = 0.95;
}

}  // namespace

Result<void> check_damage_rules(const CheckContext& context, Findings& findings) {
    if (!context.has_vectors || context.constant) return {};
    Traces traces;
    if (auto done = measure_traces(context, findings.wants("N307"), traces); !done) return done;
    check_curve(context, traces.centre, findings);
    check_alpha(context, findings);
    check_seam(context, traces.seam, findings);
    check_wall(context, findings);
    if (!context.sampled_ok) return {};
    check_exchanged(context, findings);
    check_blocks(context, traces, findings);
    check_chroma(context, findings);
    check_banding(traces.lattice, findings);
    check_posterised(context, traces.lattice, findings);
    return {};
}

}  // namespace tex::inline v1
