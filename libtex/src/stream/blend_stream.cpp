// SPDX-License-Identifier: Apache-2.0

#include "stream/blend_stream.h"

#include <vector>

#include <tex/mip_chain.h>

#include "rows/mip_rows.h"
#include "stream/blending.h"
#include "stream/level_stage.h"
#include "stream/targets.h"

namespace tex {

Result<BlendFileReport> blend_stream(MapSource& base, const std::string& output, Container container,
                                     const BlendFileOptions& options, const Execution& execution,
                                     const StreamSizes& sizes) {
    Blending blending(base, options);
    if (const Result<void> opened = blending.open(execution); !opened) return opened.error();
    BlendFileReport report;
    const int left_out = first_level(options.mip, blending.extent());
    report.extent = level_extent(blending.extent(), left_out);
    const bool holds = any_holds_levels(container, options.level_names, options.more);
    report.levels = holds ? levels_to_build(options.mip, blending.extent()) : 1;
    report.pack = packing_for(options.pack, container, blending.source());
    std::vector<FileTarget> files = {{output, options.level_names, container, report.pack, options.write}};
    add_targets(options.more, blending.source(), files);
    Targets targets;
    if (const Result<void> opened = targets.open(files, report.extent, report.levels); !opened) return opened.error();
    Flow flow;
    flow.set_rows_together(targets.rows_together());
    const bool keeps_alpha = blending.has_other_alpha() && any_holds_alpha(files);
    const MadeLevels levels{-left_out, left_out + report.levels, counted_from_base(options.mip, left_out), keeps_alpha};
    add_levels(flow, blending.add_to(flow, keeps_alpha), levels, targets);
    if (const Result<void> done = flow.run(execution, sizes); !done) return done.error();
    blending.judge(keeps_alpha && all_hold_alpha(files));
    report.source = blending.source();
    report.details = blending.details();
    if (const Result<void> committed = targets.commit(); !committed) return committed.error();
    report.bytes = targets.bytes(Content::normals);
    report.rdo = targets.rdo();
    return report;
}

Result<BlendFileReport> blend_stream(const std::string& input, const std::string& output, Container container,
                                     const BlendFileOptions& options, const Execution& execution,
                                     const StreamSizes& sizes) {
    FileMap base(input, options.source.read);
    return blend_stream(base, output, container, options, execution, sizes);
}

}  // namespace tex
