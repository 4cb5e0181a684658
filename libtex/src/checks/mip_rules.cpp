// SPDX-License-Identifier: Apache-2.0

#include "checks/mip_rules.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "checks/context.h"
#include "checks/levels.h"
#include "checks/thresholds.h"
#include "formats/level_planes.h"

namespace tex::inline v1 {
namespace {

constexpr int kLeastSide = 16;         // of a level to judge: smaller levels have too few texels
constexpr double kLeastSignal = 0.02;  // of components, 2.5 codes of 8 bits
constexpr double kLeastOfSignal = 0.35;
constexpr double kCoarseRelated = 0.5;
constexpr double kLeastDue = 0.01;  // if z is not stored: the least change by renormalising that can be seen
constexpr double kFaded = 0.7;
constexpr double kFadeRelated = 0.95;
constexpr double kFadeShort = 0.01;  // fading does not average: the vectors stay unit vectors
constexpr double kFlatGain = 0.15;

Region whole(const LevelMeasure& m) { return {m.level, 0, 0, m.extent.width, m.extent.height}; }

std::string name_level(const LevelMeasure& m) {
    return "level " + std::to_string(m.level) + " (" + extent_text(m.extent) + ")";
}

// Whether a level was not renormalised: the mean length falls as that of averages does; or, if z is not stored, x and y
// are those of the averages and not of unit vectors.
bool is_not_normalised(const LevelMeasure& m, double base_length, bool has_z) {
    const double due = base_length - m.average_length;
    // If vectors of the base level are longer than 1, renormalised ones do not count as short.
    const double short_by = std::min(base_length, 1.0) - m.length;
    if (has_z) return short_by > thresholds::kLevelShort && short_by > 0.5 * due;
    return due > kLeastDue && m.error_normalised > kLeastDue && m.error_average < 0.5 * m.error_normalised;
}

void check_lengths(const std::vector<LevelMeasure>& levels, double base_length, bool has_z, Findings& findings) {
    std::vector<Region> regions;
    const LevelMeasure* worst = nullptr;
    for (const LevelMeasure& m : levels) {
        if (!is_not_normalised(m, base_length, has_z)) continue;
        regions.push_back(whole(m));
        const auto shortness = [&](const LevelMeasure& l) { return has_z ? l.length : l.average_length; };
        if (worst == nullptr || shortness(m) < shortness(*worst)) worst = &m;
    }
    if (worst == nullptr) return;
    const double length = has_z ? worst->length : worst->average_length;
    Finding& finding = findings.add(
        "N501", std::to_string(regions.size()) + (regions.size() == 1 ? " level is" : " levels are") +
                    " not renormalised; in " + name_level(*worst) + " the mean length is " + decimal(length, 3));
    finding.figure = length;
    finding.unit = "length";
    finding.regions = std::move(regions);
}

// Whether little detail is left, relative to the level with the most: filters differ in what they leave of structures
// finer than a texel, and blocks of colours round the rest.
bool is_faint(const LevelMeasure& m, const std::vector<LevelMeasure>& levels) {
    double most = 0.0;
    for (const LevelMeasure& other : levels) most = std::max(most, other.signal);
    return m.signal < kLeastOfSignal * most;
}

void check_relations(const std::vector<LevelMeasure>& levels, double related, Findings& findings) {
    for (const LevelMeasure& m : levels) {
        if (is_faint(m, levels)) continue;
        const double shift = std::max(std::abs(m.shift_x), std::abs(m.shift_y));
        if (m.correlation > thresholds::kLevelRelated && shift > thresholds::kLevelShift && shift < 2.0) {
            Finding& finding =
                findings.add("N503", name_level(m) + " lies " + decimal(m.shift_x, 2) + " texels to the right of and " +
                                         decimal(m.shift_y, 2) + " below its place");
            finding.figure = shift;
            finding.unit = "texels";
            finding.confidence = 0.95;
            finding.regions = {whole(m)};
        } else if (m.correlation < related && m.stored_signal > kLeastSignal) {  // else the level faded to flat
            Finding& finding = findings.add("N502", name_level(m) + " correlates by " + decimal(m.correlation, 2) +
                                                        " with the filtered base level");
            finding.figure = m.correlation;
            finding.unit = "correlation";
            finding.confidence = 0.95;
            finding.regions = {whole(m)};
        }
    }
}

// Finds levels that are the base level with less and less detail, if the last level still has some.
void check_fade(const std::vector<LevelMeasure>& levels, Findings& findings) {
    const auto fades = [](const LevelMeasure& m) {
        return m.correlation > kFadeRelated && m.gain < kFaded && m.length > 1.0 - kFadeShort;
    };
    if (levels.empty() || std::none_of(levels.begin(), levels.end(), fades)) return;
    const LevelMeasure& last = levels.back();
    if (!fades(last) || last.gain < kFlatGain) return;
    Finding& finding = findings.add("N504", name_level(last) + " keeps " + percent(last.gain) + " of the detail");
    finding.figure = last.gain;
    finding.unit = "share";
    finding.confidence = 0.9;
    finding.regions = {whole(last)};
}

// Decodes what measure_level() reads of level k.
Result<Image> decode_windows(const CheckContext& context, int k) {
    const Level& level = context.texture.levels[static_cast<std::size_t>(k)];
    const std::vector<Rect> windows = sample_windows(level.extent);
    PlaneNeeds needs;
    needs.channels = 0;
    for (const Component component : {Component::x, Component::y, Component::z}) {
        const int channel = context.stored.channel(component);
        if (channel >= 0) needs.channels |= 1u << channel;
    }
    needs.rows = [&](int first, int count) {
        return std::any_of(windows.begin(), windows.end(), [&](const Rect& window) {
            return first < window.y + window.height && window.y < first + count;
        });
    };
    return decode_planes(context.texture, level, needs, context.execution);
}

}  // namespace

Result<void> check_mip_rules(const CheckContext& context, Findings& findings) {
    const Texture& texture = context.texture;
    if (!context.has_vectors || context.constant || texture.levels.size() < 2) return {};
    auto averages = base_averages(context.stored, context.execution);
    std::vector<LevelMeasure> levels;
    std::optional<Plane<float>> background;  // the share of it in each texel of the level
    for (int k = 1; k < static_cast<int>(texture.levels.size()); ++k) {
        if (k > 1) averages = averages_of(*averages, context.execution);
        if (!averages) return averages.error();
        const Extent extent = averages->extent();
        if (extent.width < kLeastSide || extent.height < kLeastSide) break;
        if (context.background)
            background = background ? background_share(*background)
                                    : background_share(*context.background, context.stored.extent());
        const auto image = decode_windows(context, k);
        if (!image) return image.error();
        Stored stored = context.stored;
        stored.image = &*image;
        LevelMeasure measure;
        if (auto done =
                measure_level(stored, *averages, k, context.execution, measure, background ? &*background : nullptr);
            !done)
            return done.error();
        if (measure.signal > kLeastSignal) levels.push_back(measure);
    }
    if (!has_free_lengths(context)) check_lengths(levels, context.counts.mean_length, context.stored.has_z(), findings);
    // Palettes of 5:6:5 bits keep less of fine noise than BC5 and DXT5nm do.
    const bool is_coarse = context.stored.in_blocks && context.stored.has_z();
    check_relations(levels, (is_coarse ? kCoarseRelated : 1.0) * thresholds::kLevelRelated, findings);
    check_fade(levels, findings);
    return {};
}

}  // namespace tex::inline v1
