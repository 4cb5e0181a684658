// SPDX-License-Identifier: Apache-2.0

#include "checks/context.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include <tex/format.h>
#include <tex/pack.h>
#include <tex/types.h>

#include "checks/centre.h"
#include "checks/channel_order.h"
#include "checks/chroma.h"
#include "checks/tone.h"
#include "checks/y_verdict.h"
#include "formats/level_planes.h"
#include "rows/extra_rows.h"
#include "rows/unpack_rows.h"

namespace tex::inline v1 {
namespace {

constexpr int kLeastSampledSide = 32;  // in texels; smaller maps get no statistics

bool same_everywhere(const TexelCounts& counts, int channels) {
    for (std::size_t c = 0; c < static_cast<std::size_t>(channels); ++c) {
        if (!(counts.high[c] == counts.low[c])) return false;
    }
    return true;
}

// Finds the transparent texels and the background, and counts without them.
Result<void> count_seen(CheckContext& context) {
    const auto count = [&]() -> Result<void> {
        auto counts =
            count_texels(context.stored, context.execution, context.background ? &*context.background : nullptr);
        if (!counts) return counts.error();
        context.counts = *counts;
        return {};
    };
    context.background = find_transparent(context.stored);
    if (context.background) context.stored.transparent = &*context.background;
    if (auto done = count(); !done) return done;
    const TexelCounts& counts = context.counts;
    context.constant = same_everywhere(counts, static_cast<int>(context.base.planes.size()));
    const double off = std::max({counts.share(Property::off_length), counts.share(Property::null_vector),
                                 counts.share(Property::beyond_unit), counts.share(Property::z_behind)});
    // Black and white that were normalised are unit vectors; a map with many of them leans.
    constexpr double kLean = 0.02;
    const double lean = std::max(std::abs(counts.mean_x), std::abs(counts.mean_y));
    if (context.constant || (off < kLeastBackground && lean < kLean)) return {};
    auto background = find_background(context.stored, context.execution, context.background);
    if (!background) return background.error();
    const bool is_found = *background && (*background)->texels > 0;
    context.background = std::move(*background);
    return is_found ? count() : Result<void>();
}

// Floats that are taken for components without (n + 1) / 2: colours of high range have no x or y below 0, and no map
// whose normals all lean into one quadrant holds few unit vectors.
bool are_bright_colors(const CheckContext& context) {
    constexpr double kMostOff = 0.9;
    const Stored& stored = context.stored;
    const TexelCounts& counts = context.counts;
    const auto is_positive = [&](Component component) {
        return counts.low[static_cast<std::size_t>(stored.channel(component))] >= 0.0f;
    };
    return stored.has_z() && format_info(context.texture.format).sample == SampleKind::floating &&
           is_positive(Component::x) && is_positive(Component::y) && counts.share(Property::off_length) > kMostOff;
}

// Where levels were changed, blue does not follow x and y as z does, and few vectors are of unit length.
bool is_after_change_of_levels(const CheckContext& context) {
    constexpr double kLead = 4.0;  // of what seems to be no map
    const Stored& stored = context.stored;
    const bool is_doubtful = context.kind == Kind::two_components || context.kind == Kind::no_map;
    const Extent extent = stored.extent();
    if (!is_doubtful || !stored.has_z() || std::min(extent.width, extent.height) < kLeastSampledSide) return false;
    const Background* const background = context.background ? &*context.background : nullptr;
    const auto fit = find_tone(stored, measure_centre(stored, background), background);
    return fit && (context.kind == Kind::two_components || fit->error * kLead < fit->as_stored);
}

// Where chroma has half the resolution of luma, the finest detail of all channels is that of luma, and looks like
// colours.
void look_past_chroma(CheckContext& context) {
    constexpr std::int64_t kLeastTexels = 1024;
    if (!context.stored.has_z() || context.stored.in_blocks ||
        !measure_chroma(context.stored, context.background ? &*context.background : nullptr).is_halved())
        return;
    const Image image = quarter_of(context.stored);
    if (image.extent().texels() < kLeastTexels) return;
    Stored quarter = context.stored;
    quarter.image = &image;
    quarter.transparent = nullptr;
    const KindMeasure measure = measure_kind(quarter, nullptr);
    if (kind_of(measure, quarter, false) != Kind::normals) return;
    context.kind = Kind::normals;
    context.kind_measure = measure;
}

// Decides whether there are normals at all, and which channels hold them.
Result<void> decide_kind(CheckContext& context) {
    Stored& stored = context.stored;
    if (context.options.any_length || context.constant) return {};
    if (stored.is_signed) {
        if (!context.options.swizzle && are_bright_colors(context)) context.kind = Kind::no_map;
        return {};
    }
    const auto with = [&](const Background* without) -> Result<Kind> {
        context.kind_measure = measure_kind(stored, without);
        Kind kind = kind_of(context.kind_measure, stored, false);
        if (kind != Kind::no_map) return kind;
        const Kind of_surface = kind_of(context.kind_measure, stored, true);
        const Extent extent = stored.extent();
        const bool is_small = std::min(extent.width, extent.height) < kLeastSampledSide;
        if (of_surface == Kind::no_map || (is_small && !stored.has_z())) return of_surface;
        if (context.kind_measure.is_flat()) return kind;  // one colour: edges between two colours have no slopes
        Stored flat = stored;
        for (Component& held : flat.swizzle) held = held == Component::z ? Component::other : held;
        const auto curl = measure_curl(flat, context.execution);
        if (!curl) return curl.error();
        if (clear_y(*curl)) return of_surface;
        if (!are_stretched(context.kind_measure)) return kind;  // else no z can be rebuilt
        const auto with_z = measure_curl(stored, context.execution);
        if (!with_z) return with_z.error();
        return clear_y(*with_z) ? of_surface : kind;
    };
    // A colour that covers nearly all of a picture is the picture.
    constexpr double kMostMasked = 0.9;
    const bool leaves_enough = context.background && static_cast<double>(context.background->masked) <
                                                         kMostMasked * static_cast<double>(stored.extent().texels());
    auto kind = with(leaves_enough ? &*context.background : nullptr);
    if (!kind) return kind.error();
    if (*kind == Kind::no_map && context.background && context.background->texels > 0) {
        // What was taken for background may be the flat parts of a map that went through the sRGB curve.
        const KindMeasure without = context.kind_measure;
        kind = with(nullptr);
        if (!kind) return kind.error();
        if (*kind == Kind::no_map) context.kind_measure = without;
    }
    context.kind = *kind;
    if (context.options.swizzle) {  // says which channels are whose
        if (context.kind != Kind::no_map) context.kind = Kind::normals;
        return {};
    }
    // Around charts on grey, JPEG leaves vectors of all directions.
    const bool has_value = context.background && context.background->texels > 0;
    if (context.kind == Kind::two_components && has_value && !context.kind_measure.alpha_varies)
        context.kind = Kind::normals;
    if (is_after_change_of_levels(context)) context.kind = Kind::normals;
    if (context.kind == Kind::two_components || context.kind == Kind::no_map) look_past_chroma(context);
    if (context.kind == Kind::two_components) {
        for (Component& held : stored.swizzle) held = held == Component::z ? Component::other : held;
    } else if (context.kind == Kind::x_ray) {
        stored.swizzle = {Component::other, Component::z, Component::y, Component::x};
    } else {
        return {};
    }
    context.background.reset();
    stored.transparent = nullptr;
    return count_seen(context);
}

}  // namespace

Result<void> measure(CheckContext& context) {
    PlaneNeeds needs;
    needs.share_constants = true;
    auto image = decode_planes(context.texture, context.texture.levels.front(), needs, context.execution);
    if (!image) return image.error();
    context.base = std::move(*image);
    Swizzle swizzle = context.texture.swizzle;
    if (context.options.swizzle) {
        swizzle = *context.options.swizzle;
        if (auto held = sources_of(swizzle, (1u << context.base.planes.size()) - 1); !held) return held.error();
    } else if (needs_texels_for_layout(context.texture)) {
        swizzle = layout_shown(context.texture, context.base);
    }
    context.stored = {&context.base, swizzle,
                      stores_signed(context.base, swizzle, range_of(context.texture.normal_encoding, {})),
                      format_info(context.texture.format).has_blocks()};
    const Stored& stored = context.stored;
    context.has_vectors = stored.channel(Component::x) >= 0 && stored.channel(Component::y) >= 0;
    if (!context.has_vectors) return {};
    if (auto done = count_seen(context); !done) return done;
    if (auto done = decide_kind(context); !done) return done;
    if (context.kind == Kind::no_map || context.kind == Kind::x_lost) {
        context.has_vectors = false;  // no other rule has anything to say about them
        return {};
    }
    const Extent extent = stored.extent();
    context.sampled_ok = !context.constant && extent.width >= kLeastSampledSide && extent.height >= kLeastSampledSide;
    if (!context.sampled_ok) return {};
    auto curl = measure_curl(stored, context.execution);
    if (!curl) return curl.error();
    context.curl = std::move(*curl);
    // The rules ask how much of the map holds normals, of what ought to.
    const auto texels = static_cast<double>(extent.texels());
    context.curl.usable =
        std::min(1.0, context.curl.usable * texels / std::max(1.0, static_cast<double>(context.counts.texels)));
    context.y.correlation = context.curl.correlation;
    context.y.confidence = context.curl.confidence;
    YVerdict verdict =
        verdict_of(context.curl, extent, [&stored](const Rect& part) { return slopes_of(stored, part); });
    context.y.y = verdict.y;
    context.mixed_y = std::move(verdict.mixed);
    return {};
}

bool has_free_lengths(const CheckContext& context) {
    return context.options.any_length || context.texture.format == Format::bc7_unorm ||
           context.texture.format == Format::uastc_4x4_unorm;
}

bool has_more_data(const Stored& stored, const TexelCounts& counts) {
    const auto& planes = stored.image->planes;
    const auto holds_component = [&](std::size_t c) {
        return stored.swizzle[c] == Component::x || stored.swizzle[c] == Component::y ||
               stored.swizzle[c] == Component::z;
    };
    const auto equal = [&](std::size_t a, std::size_t b) {
        for (int j = 0; j < stored.extent().height; ++j) {
            const float* row = planes[a].row(j);
            const auto is_near = [&](float v, float w) {
                return std::abs(v - w) <= (stored.in_blocks ? kSameInBlocks : 0.0f);
            };
            if (!std::equal(row, row + stored.extent().width, planes[b].row(j), is_near)) return false;
        }
        return true;
    };
    const std::size_t channels = std::min(planes.size(), stored.swizzle.size());
    for (std::size_t c = 0; c < channels; ++c) {
        if (holds_component(c) || counts.high[c] - counts.low[c] <= (stored.in_blocks ? kBlockError : 0.0f)) continue;
        bool copied = false;
        for (std::size_t other = 0; other < channels; ++other)
            copied = copied || (holds_component(other) && equal(c, other));
        if (!copied) return true;
    }
    return false;
}

}  // namespace tex::inline v1
