// SPDX-License-Identifier: Apache-2.0

#include "stream/source_layout.h"

#include <tex/format.h>

#include "checks/channel_order.h"
#include "formats/row_source.h"
#include "rows/unpack_rows.h"

namespace tex::inline v1 {
namespace {

bool is_bc5(Format format) { return format == Format::bc5_unorm || format == Format::bc5_snorm; }

bool leaves_a_choice(const Texture& head) {
    return head.order_open || (!head.swizzle_known && format_info(head.format).channels == 4);
}

}  // namespace

std::optional<Swizzle> known_swizzle(const Texture& head, const SourceOptions& options) {
    if (options.unpack.swizzle) return options.unpack.swizzle;
    if (options.bc5_swizzle && is_bc5(head.format)) return options.bc5_swizzle;
    if (leaves_a_choice(head)) return std::nullopt;
    if (options.r_or_a) return guessed_swizzle(head.swizzle, options);
    return head.swizzle;
}

Swizzle guessed_swizzle(const Swizzle& guess, const SourceOptions& options) {
    return options.r_or_a && guess[3] != Component::x ? kSwizzleXy : guess;
}

Result<FoundSwizzle> find_swizzle(const Texture& texture, const SourceOptions& options, const Execution& execution) {
    if (const std::optional<Swizzle> known = known_swizzle(texture, options)) return FoundSwizzle{*known};
    const Execution silent = execution.quiet();
    if (texture.order_open) {
        const Result<std::optional<Swizzle>> shown = shown_order(texture, silent);
        if (!shown) return shown.error();
        return FoundSwizzle{shown->value_or(texture.swizzle), !shown->has_value()};
    }
    Result<Swizzle> guess = guess_swizzle(texture, silent);
    if (!guess) return guess.error();
    return FoundSwizzle{guessed_swizzle(*guess, options)};
}

SourceInfo source_info(const Texture& head, const FoundSwizzle& found, const SourceOptions& options) {
    SourceInfo info;
    info.format = head.format;
    info.swizzle = found.swizzle;
    info.order_assumed = found.order_assumed;
    info.z01 = found.z01;
    const bool as_expected = head.order_open
                                 ? found.swizzle == head.swizzle || options.bc5_swizzle
                                 : name_of(kSwizzleNames, found.swizzle) == "rgb" && head.swizzle[3] != Component::x;
    info.guessed = leaves_a_choice(head) && !options.unpack.swizzle && !options.r_or_a && !as_expected;
    const bool told = options.file_y_first && head.y_known;
    info.y_known = head.y_known || options.unpack.y_axis;
    info.y_axis = told ? head.y_axis : options.unpack.y_axis.value_or(head.y_axis);
    info.srgb = head.srgb;
    info.remarks = head.remarks;
    if (head.trailing_bytes > 0) info.remarks.push_back(trailing_text(head.trailing_bytes));
    if (head.orientation != 1)
        info.remarks.push_back(orientation_text(head.orientation, head.turned) +
                               (head.turned ? "; vectors stay as they are stored" : ""));
    return info;
}

UnpackOptions unpack_options(const SourceInfo& info, const SourceOptions& options) {
    UnpackOptions unpack = options.unpack;
    unpack.swizzle = info.swizzle;
    unpack.y_axis = info.y_axis;
    return unpack;
}

bool leaves_blue_open(const Texture& head, const SourceOptions& options) {
    const FormatInfo info = format_info(head.format);
    return info.channels >= 3 && info.sample == SampleKind::unorm && !head.swizzle_known && !options.unpack.swizzle &&
           !options.r_or_a && options.unpack.range == ValueRange::automatic;
}

Result<void> settle_blue(const BlueEvidence& blue, const Sources& sources, SourceOptions& options) {
    if (blue.lacks_x()) {
        return Error{
            ErrorCode::bad_data,
            {},
            "x is not in the file: red and blue are 1 everywhere, as in DXT5nm, whose alpha, which holds x, is "
            "missing; export it again with its alpha"};
    }
    const bool reads_rgb = sources.x == 0 && sources.y == 1 && sources.z == 2;
    if (reads_rgb && blue.is_z01()) options.unpack.range = ValueRange::z01;
    return {};
}

Result<void> check_channels(const Texture& head) {
    if (format_info(head.format).channels > 1) return {};
    return Error{ErrorCode::unsupported, {}, kOneChannel};
}

}  // namespace tex::inline v1
