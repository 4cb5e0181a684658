// SPDX-License-Identifier: Apache-2.0

#include "stream/settled_map.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "checks/channel_order.h"
#include "rows/swizzle_evidence.h"
#include "stream/map_inspector.h"
#include "stream/source_layout.h"

namespace tex::inline v1 {

Result<void> SettledMap::open(const Execution& execution) {
    if (options_.fill_background && !filled_) {
        filled_ = filled(*map_, options_, execution);
        map_ = filled_.get();
    }
    if (Result<void> opened = map_->open(); !opened) return opened.error().of(map_->path());
    if (Result<void> settled = settle(); !settled) return settled.error().of(map_->path());
    if (!options_.measure_y) return {};
    if (Result<void> measured = measure_y(execution); !measured) return measured.error().of(map_->path());
    return map_->open();
}

// The swizzle that the texels show.
Result<Swizzle> SettledMap::find_layout() {
    SwizzleEvidence evidence(map_->extent(0), map_->head());
    int row = 0;
    const Result<void> seen = map_->look([&](const float* const(&channels)[4]) {
        evidence.add_row(row++, channels);
        return !evidence.is_certain();
    });
    if (!seen) return seen.error();
    if (Result<void> again = map_->open(); !again) return again.error();
    return guessed_swizzle(evidence.layout(), options_);
}

// The order of x and y that the texels show.
Result<Swizzle> SettledMap::find_order() {
    ChannelOrder order(map_->extent(0));
    int row = 0;
    const Result<void> seen = map_->look([&](const float* const(&channels)[4]) {
        order.add_row(row++, channels[0], channels[1]);
        return true;
    });
    if (!seen) return seen.error();
    if (Result<void> again = map_->open(); !again) return again.error();
    const std::optional<Swizzle> shown = order.shown();
    order_assumed_ = !shown;
    return shown.value_or(map_->head().swizzle);
}

// Whether z is stored in the usual way, if it is stored, and whether x is.
Result<void> SettledMap::look_at_blue() {
    is_blue_seen_ = true;
    BlueEvidence blue;
    const int width = map_->extent(0).width;
    const Result<void> seen = map_->look([&](const float* const(&channels)[4]) {
        blue.add_row(channels, width);
        return !blue.is_certain();
    });
    if (!seen) return seen.error();
    if (Result<void> again = map_->open(); !again) return again.error();
    if (Result<void> settled = settle_blue(blue, sources_, options_); !settled) return settled;
    is_z01_ = options_.unpack.range == ValueRange::z01;
    return {};
}

// Whether floats, of which the file does not say it, are unsigned: one negative value shows that they are not.
Result<bool> SettledMap::find_range() {
    RangeEvidence range;
    const int width = map_->extent(0).width;
    const Result<void> seen = map_->look([&](const float* const(&channels)[4]) {
        const VectorRow vectors = vectors_of(channels, sources_);
        range.add(weigh_row(vectors.x, vectors.y, vectors.z, width));
        return !range.negative;
    });
    if (!seen) return seen.error();
    if (Result<void> again = map_->open(); !again) return again.error();
    return range.says_unsigned();
}

Result<void> SettledMap::settle() {
    const Texture& head = map_->head();
    if (const Result<void> fit = check_channels(head); !fit) return map_->after_all_rows(fit.error().of(map_->path()));
    if (!swizzle_) swizzle_ = map_->found_swizzle();
    if (!swizzle_) swizzle_ = known_swizzle(head, options_);
    if (!swizzle_) {
        const Result<Swizzle> found = head.order_open ? find_order() : find_layout();
        if (!found) return found.error();
        swizzle_ = *found;
    }
    const FormatInfo format = format_info(head.format);
    const bool leaves_open = leaves_blue_open(head, options_) && !map_->has_y_up();
    const Result<Sources> sources = sources_of(*swizzle_, (1u << format.channels) - 1);
    if (!sources) return map_->after_all_rows(sources.error().of(map_->path()));
    sources_ = *sources;
    if (leaves_open && !is_blue_seen_) {
        if (Result<void> settled = look_at_blue(); !settled) return settled;
    }
    if (!is_unsigned_) is_unsigned_ = is_unsigned(format.sample, range_of(head.normal_encoding, options_.unpack));
    if (!is_unsigned_) {
        const Result<bool> found = find_range();
        if (!found) return found.error();
        is_unsigned_ = *found;
    }
    info_ = source_info(map_->head(), {*swizzle_, order_assumed_, is_z01_}, options_);
    YAxis y = info_.y_axis;
    if (map_->has_y_up()) y = info_.y_axis == map_->head().y_axis ? YAxis::up : YAxis::down;
    rule_ = rule_of(unpack_options(info_, options_), format.sample, format.bits, y);
    rule_.is_unsigned = *is_unsigned_;
    return {};
}

Result<void> SettledMap::measure_y(const Execution& execution) {
    options_.measure_y = options_.file_y_first = false;
    options_.unpack.y_axis = YAxis::up;
    if (Result<void> settled = settle(); !settled) return settled;
    rule_.keep_length = true;  // the check judges what is stored
    MapInspector inspector(map_->extent(0), true, Look::as_check);
    Flow flow;
    add_to(flow, 0, {{}, &inspector});
    if (Result<void> seen = flow.run(execution.quiet()); !seen) return seen;
    const Result<YAxis> shown = measured_y(inspector.y(), options_);
    if (!shown) return shown.error().of(map_->path());
    options_.unpack.y_axis = *shown;
    return settle();
}

ExtraSet SettledMap::extras() const { return extras_beside(sources_, format_info(map_->head().format).channels); }

Result<bool> SettledMap::alpha_is_one() {
    if (map_->has_y_up()) return false;  // another step makes it
    const int width = map_->extent(0).width;
    bool is_one = true;
    const Result<void> seen = map_->look([&](const float* const(&channels)[4]) {
        const float* const alpha = channels[channel_of(Extra::alpha)];
        is_one = alpha != nullptr && std::all_of(alpha, alpha + width, [](float value) { return value == 1.0f; });
        return is_one;
    });
    if (!seen) return seen.error();
    if (Result<void> again = map_->open(); !again) return again.error();
    return is_one;
}

ExtraSet SettledMap::extras_taken() const {
    return options_.drop_others ? ExtraSet() : extras() & options_.unpack.others;
}

Stage& SettledMap::add_to(Flow& flow, int level, const UnpackPlan& plan) const {
    StoredChannels channels = map_->add_to(flow, level, wanted_channels(sources_, plan));
    return flow.add<UnpackStage>(std::move(channels), sources_, rule_, plan);
}

}  // namespace tex::inline v1
