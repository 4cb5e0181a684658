// SPDX-License-Identifier: Apache-2.0

#include "stream/bake_stream.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "rows/mip_rows.h"
#include "stream/height_stage.h"
#include "stream/last_rows.h"
#include "stream/level_stage.h"
#include "stream/slope_collector.h"
#include "stream/strip_writer.h"

namespace tex {
namespace {

HeightFieldHead head_of(Extent extent, const BakeFileOptions& options) {
    const Strength strength = options.strength ? options.strength(extent) : Strength();
    return {strength.x, strength.y, options.heights.wrap_x, options.heights.wrap_y};
}

int levels_of(Extent extent, Container container, const BakeFileOptions& options) {
    return holds_levels(container, options.level_names) ? levels_to_build(options.mip, extent) : 1;
}

// What is written from the top cannot wait for the last rows to come.
bool needs_last_rows(Container container, const BakeFileOptions& options) {
    return !takes_any_order(container) && options.heights.wrap_y == Wrap::repeat;
}

}  // namespace

bool can_stream(const InputFile& file, const RowSource& rows, Container container, const BakeFileOptions& options) {
    if (!rows.is_sequential() || !options.color.space.empty() || options.heights.fill_invalid) return false;
    if (!takes_strips(container)) return false;
    return !needs_last_rows(container, options) || knows_last_rows(file, rows);
}

Result<BakeFileReport> bake_stream(InputFile& file, std::unique_ptr<RowSource> rows, const std::string& output,
                                   Container container, const BakeFileOptions& options, const Execution& execution,
                                   const StreamSizes& sizes) {
    const std::string& input = file.path();
    const Extent extent = rows->extent();
    const std::optional<Error> wrong_blur = check_blur(options.heights);
    const Result<HeightSource> source = find_height_source(rows->names(), options.heights.channel);
    if (wrong_blur || !source) return after_all_rows(*rows, input, wrong_blur ? *wrong_blur : source.error());
    const Gradient gradient = gradient_of(options.bake);
    std::optional<Image> last;
    if (needs_last_rows(container, options)) {
        const int count = std::min(HeightStage::reach(options.heights, gradient), extent.height);
        Result<Image> known = last_rows(file, rows, options.read, count, execution);
        if (!known) return known.error();
        last = std::move(*known);
    }
    BakeFileReport report;
    report.path = Path::streamed;
    report.extent = extent;
    report.levels = levels_of(extent, container, options);
    const Result<std::unique_ptr<StripWriter>> opened = StripWriter::open(
        {output, options.level_names}, container, packing_of(options.pack, extent, report.levels), options.write);
    if (!opened) return opened.error();
    StripWriter& writer = **opened;
    RowStream stream(*rows, input, 0, report.levels, writer, execution, sizes);
    SlopeCollector slopes;
    if (options.slopes) {
        stream.watch([&slopes](const Strip& strip) {
            if (strip.level == 0) slopes.add(strip.map, 0, strip.height);
        });
    }
    HeightStage heights(extent, *source, options.heights, gradient, head_of(extent, options), stream.sink(),
                        std::move(last));
    LevelStage levels(extent, report.levels, heights.start(), options.mip, stream.strips());
    if (const Result<void> done = stream.run(heights, levels); !done) return done.error();
    if (const Result<void> done = writer.commit(); !done) return done.error();
    report.bytes = writer.file_bytes();
    report.heights = {heights.counts().luma, heights.counts().invalid};
    report.slopes = slopes.range();
    return report;
}

}  // namespace tex
