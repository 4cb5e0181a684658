// SPDX-License-Identifier: Apache-2.0

#include "stream/open_heights.h"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

#include "color/color.h"
#include "formats/ground.h"
#include "rows/ground.h"
#include "stream/filled_heights.h"
#include "stream/height_stage.h"
#include "stream/last_rows.h"
#include "stream/occluded_heights.h"
#include "stream/source_stage.h"
#include "stream/terrain_rows.h"
#include "threads/parallel.h"

namespace tex::inline v1 {
namespace {

// Errors: those of an option that does not fit the picture.
Result<void> prepare(const InputFile& file, const BakeFileOptions& options, Heights& heights) {
    const RowSource& rows = *heights.rows;
    const PictureHead& head = rows.head();
    if (!options.color.space.empty()) {
        auto linear = linear_rows(head.names, head.sample, head.bits, options.color.config, options.color.space);
        if (!linear) return linear.error();
        heights.linear = std::move(*linear);
    }
    if (auto valid = validate(options.heights); !valid) return valid.error();
    heights.stored = head.stored;
    heights.remark = head.remark;
    heights.assumes_no_data = head.is_no_data_assumed && !options.heights.no_data;
    heights.stated = head.strength;
    Result<HeightSource> source = find_height_source(head, options.heights);
    if (!source) return source.error();
    heights.source = *source;
    if (have_unit(head, *source) && !heights.linear) {
        GroundFound found = ground_of(rows, file);
        heights.ground = found.ground;
        heights.ground_remark = std::move(found.remark);
    }
    Result<HeightOptions> with =
        with_no_data(options.heights, head, heights.source, heights.linear ? &*heights.linear : nullptr);
    if (!with) return with.error();
    heights.options = *with;
    return {};
}

// Whether a stage needs all rows at once.
bool needs_all_rows(const BakeFileOptions& options) {
    return options.heights.fill_invalid || options.heights.deband != Deband::off ||
           (wants_occlusion(options) && !options.tile);
}

// The rows are heights that take_heights() has cleaned.
void take_cleaned(Heights& heights) {
    heights.source = {HeightChannel::automatic, 0};
    heights.linear.reset();
    heights.options.invert = false;
    heights.options.deband = Deband::off;
    heights.options.no_data = std::numeric_limits<float>::quiet_NaN();
}

// Debands heights, and fills invalid ones.
Result<void> fill(InputFile& file, const Execution& execution, bool keeps_holes, Heights& heights) {
    Result<std::unique_ptr<RowSource>> filled = fill_heights(
        *heights.rows, file.path(), heights.source, heights.options, heights.linear ? &*heights.linear : nullptr,
        execution, heights.counts, heights.deband, keeps_holes ? &heights.with_holes : nullptr);
    if (!filled) return filled.error();
    heights.rows = std::move(*filled);
    heights.terrain = nullptr;
    take_cleaned(heights);
    return {};
}

// The heights of a tile with those around it, which were cleaned already.
Result<Heights> open_terrain(InputFile& file, const BakeFileOptions& options, const Gradient& gradient) {
    if (options.auto_strength || options.heights.deband != Deband::off)
        return Error{ErrorCode::bad_option, {}, "tiles of a terrain are not debanded or measured one by one"};
    Result<std::unique_ptr<TerrainRows>> rows =
        TerrainRows::open(file, options, height_reach(options.heights, gradient));
    if (!rows) return rows.error();
    Heights heights;
    heights.window = (*rows)->window();
    heights.stored = (*rows)->heights().stored;
    heights.remark = (*rows)->heights().remark;
    heights.assumes_no_data = (*rows)->heights().assumes_no_data;
    heights.ground = (*rows)->heights().ground;
    heights.ground_remark = (*rows)->heights().ground_remark;
    heights.options = options.heights;
    heights.options.wrap_x = heights.window->wrap_x;
    heights.options.wrap_y = heights.window->wrap_y;
    take_cleaned(heights);
    heights.terrain = rows->get();
    heights.rows = std::move(*rows);
    return heights;
}

// Output that is written from the top cannot wait until the last rows arrive.
Result<void> find_last_rows(InputFile& file, const BakeFileOptions& options, const Gradient& gradient,
                            const Execution& execution, Heights& heights) {
    const int count = std::min(height_reach(heights.options, gradient), heights.rows->extent().height);
    Result<Image> last = last_rows(file, heights.rows, options.read, count, execution);
    if (!last) return last.error();
    heights.last = std::move(*last);
    return heights.linear ? heights.linear->convert(*heights.last, count) : Result<void>();
}

}  // namespace

HeightReport report_of(const Heights& heights, const HeightCounts& counts) {
    HeightReport report = report_of(counts, heights.deband, heights.stored);
    report.ground = heights.ground;
    report.ground_remark = heights.ground_remark;
    return report;
}

HeightFieldHead head_of(const Heights& heights, const BakeFileOptions& options) {
    const Extent extent = heights.window ? heights.window->tile : heights.rows->extent();
    Strength strength = options.strength ? options.strength(extent) : heights.stated.value_or(Strength());
    strength.x *= options.vertical_scale;
    strength.y *= options.vertical_scale;
    HeightFieldHead head{strength.x, strength.y, heights.options.wrap_x, heights.options.wrap_y};
    if (options.strength || heights.stated) return head;
    head.ground = heights.ground;
    head.ground_row = heights.window ? -heights.window->top : 0;
    return head;
}

std::string remark_with_counts(const Heights& heights, std::string remark, const HeightCounts& counts) {
    if (!heights.assumes_no_data || counts.invalid == 0) return remark;
    if (!remark.empty()) remark += "; ";
    return remark + std::to_string(counts.invalid) +
           (counts.invalid == 1 ? " height is -9999 and was" : " heights are -9999 and were") +
           " taken as missing, although the file names no no-data value";
}

Result<Heights> open_height_rows(InputFile& file, const BakeFileOptions& options) {
    Result<std::unique_ptr<RowSource>> rows = open_rows(file, options.read);
    if (!rows) return rows.error();
    Heights heights;
    heights.rows = std::move(*rows);
    if (const Result<void> fits = prepare(file, options, heights); !fits)
        return after_all_rows(*heights.rows, file.path(), fits.error());
    return heights;
}

Result<Heights> open_heights(InputFile& file, RowOrder order, const BakeFileOptions& options, const Gradient& gradient,
                             const Execution& execution) {
    Result<Heights> opened = options.tile ? open_terrain(file, options, gradient) : open_height_rows(file, options);
    if (!opened) return opened.error();
    Heights heights = std::move(*opened);
    if (needs_all_rows(options)) {
        const Result<void> filled = fill(file, execution, wants_occlusion(options) && !options.tile, heights);
        if (!filled) return filled.error();
    }
    if (order == RowOrder::from_the_top && heights.options.wrap_y == Wrap::repeat) {
        const double done = needs_all_rows(options) ? 1.0 : 0.0;
        const Result<void> found = find_last_rows(file, options, gradient, part_of(execution, done, 1.0), heights);
        if (!found) return found.error();
    }
    return heights;
}

}  // namespace tex::inline v1
