// SPDX-License-Identifier: Apache-2.0

#include "stream/bake_stream.h"

#include <memory>
#include <utility>
#include <vector>

#include <tex/mip_chain.h>

#include "rows/mip_rows.h"
#include "stream/height_stage.h"
#include "stream/level_stage.h"
#include "stream/open_heights.h"
#include "stream/shared_writer.h"
#include "stream/slope_collector.h"
#include "stream/terrain_rows.h"
#include "stream/usual_slope.h"
#include "threads/parallel.h"

namespace tex {

Result<BakeFileReport> bake_stream(InputFile& file, const std::string& output, Container container,
                                   const BakeFileOptions& options, const Execution& execution,
                                   const StreamSizes& sizes) {
    if (options.auto_strength) {
        const Result<BakeFileOptions> measured = with_measured_strength(file, options, execution);
        if (!measured) return measured.error();
        return bake_stream(file, output, container, *measured, execution, sizes);
    }
    // Progress: debanding and filling come before the rest of the work.
    const bool debands = options.heights.deband != Deband::off;
    const double filled = debands ? 0.7 : options.heights.fill_invalid ? 0.5 : 0.0;
    const Gradient gradient = gradient_of(options.bake);
    const RowOrder order = all_take_any_order(container, options.more) ? RowOrder::any : RowOrder::from_the_top;
    Result<Heights> heights = open_heights(file, order, options, gradient, part_of(execution, 0.0, filled));
    if (!heights) return heights.error();
    const Execution onward = part_of(execution, filled, 1.0);
    const Extent read = heights->rows->extent(), extent = heights->window ? heights->window->tile : read;
    BakeFileReport report;
    const int first = first_level(options.mip, extent);
    report.extent = level_extent(extent, first);
    if (any_holds_levels(container, options.level_names, options.more))
        report.levels = levels_to_build(options.mip, extent);
    std::vector<FileTarget> targets = {{{output, options.level_names}, container, options.pack, options.write}};
    add_targets(options.more, {}, targets);
    const Result<std::unique_ptr<StripWriter>> opened = open_targets(targets, report.extent, report.levels);
    if (!opened) return opened.error();
    StripWriter& writer = **opened;
    RowStream stream(*heights->rows, file.path(), -first, first + report.levels, writer, onward, sizes, extent);
    if (heights->linear) stream.convert([&](Image& rows, int count) { return heights->linear->convert(rows, count); });
    SlopeCollector slopes(steepest_slope(options.pack.encoding), options.slopes);
    UsualSlope usual(report.extent);
    stream.watch([&](const Strip& strip) {
        if (strip.level != 0) return;
        slopes.add(strip.map, 0, strip.height);
        for (int j = 0; j < strip.height; ++j) {
            if (usual.wants(strip.first + j)) usual.add({strip.map.x.row(j), strip.map.y.row(j), strip.map.z.row(j)});
        }
    });
    HeightFieldHead head = head_of(extent, options, heights->stated);
    head.wrap_x = heights->options.wrap_x;
    head.wrap_y = heights->options.wrap_y;
    HeightStage stage(read, heights->source, heights->options, gradient, head,
                      heights->window ? without_margins(*heights->window, stream.sink()) : stream.sink(),
                      std::move(heights->last));
    LevelStage levels(extent, first + report.levels, heights->window ? 0 : stage.start(),
                      counted_from_base(options.mip, first), stream.strips());
    if (const Result<void> done = stream.run(stage, levels); !done) return done.error();
    if (const Result<void> done = writer.commit(); !done) return done.error();
    report.bytes = writer.file_bytes();
    report.rdo = writer.rdo();
    const auto* const terrain = dynamic_cast<const TerrainRows*>(heights->rows.get());
    HeightCounts counts = heights->counts;
    counts += terrain != nullptr ? terrain->counts() : stage.counts();
    report.heights = report_of(counts, heights->deband, heights->stored);
    report.heights.remark = terrain != nullptr ? terrain->remark() : heights->remark;
    report.strength = {head.bumpiness_x, head.bumpiness_y};
    report.is_stated = !options.strength && heights->stated;
    report.usual_slope = usual.slope();
    report.slopes = slopes.range();
    report.steep_texels = slopes.steep_texels();
    return report;
}

}  // namespace tex
