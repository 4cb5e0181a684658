// SPDX-License-Identifier: Apache-2.0

#include "stream/bake_stream.h"

#include <algorithm>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "formats/row_source.h"
#include "rows/color.h"
#include "rows/mip_rows.h"
#include "stream/filled_heights.h"
#include "stream/height_stage.h"
#include "stream/last_rows.h"
#include "stream/level_stage.h"
#include "stream/slope_collector.h"
#include "stream/strip_writer.h"
#include "threads/parallel.h"

namespace tex {
namespace {

HeightFieldHead head_of(Extent extent, const BakeFileOptions& options) {
    const Strength strength = options.strength ? options.strength(extent) : Strength();
    return {strength.x, strength.y, options.heights.wrap_x, options.heights.wrap_y};
}

int levels_of(Extent extent, Container container, const BakeFileOptions& options) {
    return holds_levels(container, options.level_names) ? levels_to_build(options.mip, extent) : 1;
}

// A picture, and what happens to its rows before they become normals.
struct Heights {
    std::unique_ptr<RowSource> rows;
    HeightSource source;
    std::optional<LinearRows> linear;  // if the picture is in another colour space
    HeightOptions options;
    HeightCounts counts;        // found so far
    std::optional<Image> last;  // the last rows, if they are needed first
};

// Errors: those of an option that does not fit the picture.
Result<void> prepare(const BakeFileOptions& options, Heights& heights) {
    const RowSource& rows = *heights.rows;
    if (!options.color.space.empty()) {
        auto linear =
            LinearRows::make(rows.names(), rows.sample(), rows.bits(), options.color.config, options.color.space);
        if (!linear) return linear.error();
        heights.linear = std::move(*linear);
    }
    if (std::optional<Error> wrong = check_blur(options.heights)) return std::move(*wrong);
    Result<HeightSource> source = find_height_source(rows.names(), options.heights.channel);
    if (!source) return source.error();
    heights.source = *source;
    Result<HeightOptions> with = with_no_data(options.heights, rows.no_data(), rows.names(), heights.source,
                                              heights.linear ? &*heights.linear : nullptr);
    if (!with) return with.error();
    heights.options = *with;
    return {};
}

// Fills invalid heights. This stage needs all rows at once.
Result<void> fill(InputFile& file, const Execution& execution, Heights& heights) {
    Result<std::unique_ptr<RowSource>> filled =
        fill_heights(*heights.rows, file.path(), heights.source, heights.options,
                     heights.linear ? &*heights.linear : nullptr, execution, heights.counts);
    if (!filled) return filled.error();
    heights.rows = std::move(*filled);
    heights.source = {HeightChannel::automatic, 0};
    heights.linear.reset();
    heights.options.invert = false;
    heights.options.no_data = std::numeric_limits<float>::quiet_NaN();
    return {};
}

// Output that is written from the top cannot wait until the last rows arrive.
Result<void> find_last_rows(InputFile& file, const BakeFileOptions& options, const Gradient& gradient,
                            const Execution& execution, Heights& heights) {
    const int count = std::min(HeightStage::reach(heights.options, gradient), heights.rows->extent().height);
    Result<Image> last = last_rows(file, heights.rows, options.read, count, execution);
    if (!last) return last.error();
    heights.last = std::move(*last);
    return heights.linear ? heights.linear->convert(*heights.last, count) : Result<void>();
}

Result<Heights> open_heights(InputFile& file, Container container, const BakeFileOptions& options,
                             const Gradient& gradient, const Execution& execution) {
    Result<std::unique_ptr<RowSource>> rows = open_rows(file, options.read);
    if (!rows) return rows.error();
    Heights heights;
    heights.rows = std::move(*rows);
    if (const Result<void> fits = prepare(options, heights); !fits)
        return after_all_rows(*heights.rows, file.path(), fits.error());
    if (options.heights.fill_invalid) {
        if (const Result<void> filled = fill(file, execution, heights); !filled) return filled.error();
    }
    if (!takes_any_order(container) && options.heights.wrap_y == Wrap::repeat) {
        const double done = options.heights.fill_invalid ? 1.0 : 0.0;
        const Result<void> found = find_last_rows(file, options, gradient, part_of(execution, done, 1.0), heights);
        if (!found) return found.error();
    }
    return heights;
}

}  // namespace

Result<BakeFileReport> bake_stream(InputFile& file, const std::string& output, Container container,
                                   const BakeFileOptions& options, const Execution& execution,
                                   const StreamSizes& sizes) {
    // Progress: filling comes before the rest of the work.
    const double filled = options.heights.fill_invalid ? 0.5 : 0.0;
    const Gradient gradient = gradient_of(options.bake);
    Result<Heights> heights = open_heights(file, container, options, gradient, part_of(execution, 0.0, filled));
    if (!heights) return heights.error();
    const Execution onward = part_of(execution, filled, 1.0);
    const Extent extent = heights->rows->extent();
    BakeFileReport report;
    report.extent = extent;
    report.levels = levels_of(extent, container, options);
    const Result<std::unique_ptr<StripWriter>> opened = StripWriter::open(
        {output, options.level_names}, container, packing_of(options.pack, extent, report.levels), options.write);
    if (!opened) return opened.error();
    StripWriter& writer = **opened;
    RowStream stream(*heights->rows, file.path(), 0, report.levels, writer, onward, sizes);
    if (heights->linear) stream.convert([&](Image& rows, int count) { return heights->linear->convert(rows, count); });
    SlopeCollector slopes(steepest_slope(options.pack.encoding), options.slopes);
    stream.watch([&slopes](const Strip& strip) {
        if (strip.level == 0) slopes.add(strip.map, 0, strip.height);
    });
    HeightStage stage(extent, heights->source, heights->options, gradient, head_of(extent, options), stream.sink(),
                      std::move(heights->last));
    LevelStage levels(extent, report.levels, stage.start(), options.mip, stream.strips());
    if (const Result<void> done = stream.run(stage, levels); !done) return done.error();
    if (const Result<void> done = writer.commit(); !done) return done.error();
    report.bytes = writer.file_bytes();
    const HeightCounts& counts = stage.counts();
    report.heights = {heights->counts.luma + counts.luma, heights->counts.invalid + counts.invalid};
    report.slopes = slopes.range();
    report.steep_texels = slopes.steep_texels();
    return report;
}

}  // namespace tex
