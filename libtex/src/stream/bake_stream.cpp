// SPDX-License-Identifier: Apache-2.0

#include "stream/bake_stream.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include <tex/types.h>

#include "rows/border_slope.h"
#include "rows/mip_rows.h"
#include "stream/given_extras.h"
#include "stream/height_stage.h"
#include "stream/level_stage.h"
#include "stream/occluded_heights.h"
#include "stream/occluded_tile.h"
#include "stream/open_heights.h"
#include "stream/slope_collector.h"
#include "stream/targets.h"
#include "stream/terrain_rows.h"
#include "stream/usual_slope.h"
#include "threads/parallel.h"

namespace tex::inline v1 {

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
    const bool occludes = wants_occlusion(options);
    const double filled = debands ? 0.7 : occludes ? 0.1 : options.heights.fill_invalid ? 0.5 : 0.0;
    const Gradient gradient = gradient_of(options.bake);
    const RowOrder order = all_take_any_order(container, options.more) ? RowOrder::any : RowOrder::from_the_top;
    Result<Heights> heights = open_heights(file, order, options, gradient, part_of(execution, 0.0, filled));
    if (!heights) return heights.error();
    const double occluded = occludes ? 0.9 : filled;
    const Execution onward = part_of(execution, occluded, 1.0);
    const Extent extent = heights->window ? heights->window->tile : heights->rows->extent();
    BakeFileReport report;
    const int first = first_level(options.mip, extent);
    report.extent = level_extent(extent, first);
    report.left_out = first;
    if (any_holds_levels(container, options.level_names, options.more))
        report.levels = levels_to_build(options.mip, extent);
    std::vector<FileTarget> files = {{output, options.level_names, container, options.pack, options.write}};
    add_targets(options.more, {}, files);
    const Execution occluding = part_of(execution, filled, occluded);
    if (occludes && options.tile) {
        auto tile = occluded_tile(file.path(), head_of(*heights, options), options, occluding);
        if (!tile) return tile.error();
        report.occlusion = std::move(tile->maps);
        report.occlusion_reach = tile->reach;
    } else if (occludes) {
        auto maps = occluded_heights(std::move(heights->with_holes), head_of(*heights, options), options, occluding);
        if (!maps) return maps.error();
        report.occlusion = std::move(*maps);
    }
    const Result<GivenExtras> given =
        GivenExtras::read(with_occlusion(options.others, report.occlusion), extent, files);
    if (!given) return given.error();
    Targets targets;
    if (const Result<void> opened = targets.open(files, given->planes(), report.extent, report.levels); !opened)
        return opened.error();
    SlopeCollector slopes(steepest_slope(options.pack.encoding), options.slopes);
    std::optional<UsualSlope> usual;    // once the strength is known
    std::optional<BorderSlope> border;  // of heights that repeat
    const WatchRows seen = [&](const LevelRows& rows) {
        if (rows.level != 0) return;
        slopes.add(rows.map, 0, rows.height);
        for (int j = 0; j < rows.height; ++j) {
            const VectorRow row{rows.map.x.row(j), rows.map.y.row(j), rows.map.z.row(j)};
            if (usual->wants(rows.first + j)) usual->add(row);
            if (border) border->add(rows.first + j, row);
        }
    };
    const HeightCounts before = heights->counts;
    Flow flow;
    flow.set_rows_together(targets.rows_together());
    const BakedRows baked = add_bake(flow, *heights, file.path(), options, gradient);
    usual.emplace(report.extent, std::max(std::abs(baked.head.bumpiness_x), std::abs(baked.head.bumpiness_y)));
    if (baked.head.wrap_x == Wrap::repeat || baked.head.wrap_y == Wrap::repeat) border.emplace(report.extent);
    const MadeLevels levels{-first, first + report.levels, counted_from_base(options.mip, first), given->planes()};
    add_levels(flow, given->add_to(flow, *baked.normals), levels, targets, seen);
    if (const Result<void> done = flow.run(onward, sizes); !done) return done.error();
    const TerrainRows* const terrain = heights->terrain;
    HeightCounts counts = heights->counts;
    if (terrain != nullptr) (counts = before) += terrain->counts();
    report.heights = report_of(*heights, counts);
    report.heights.remark =
        remark_with_counts(*heights, terrain != nullptr ? terrain->remark() : heights->remark, counts);
    if (options.accept) {
        if (const Result<void> accepted = options.accept(report.heights); !accepted) return accepted.error();
    }
    if (const Result<void> done = targets.commit(); !done) return done.error();
    if (!options.occlusion || !options.occlusion->occlusion) report.occlusion.occlusion = {};
    report.bytes = targets.bytes(Content::normals);
    report.rdo = targets.rdo();
    report.strength = middle_strength(baked.head, extent);
    report.is_stated = !options.strength && heights->stated;
    report.on_ground = baked.head.ground.has_value();
    report.usual_slope = usual->slope();
    report.auto_strength = usual->strength_for_one();
    report.border_ratio = border ? border->ratio() : 0.0;
    report.slopes = slopes.range();
    report.steep_texels = slopes.steep_texels();
    return report;
}

}  // namespace tex::inline v1
