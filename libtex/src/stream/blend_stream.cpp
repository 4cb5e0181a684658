// SPDX-License-Identifier: Apache-2.0

#include "stream/blend_stream.h"

#include <vector>

#include <tex/types.h>

#include "rows/mip_rows.h"
#include "stream/blending.h"
#include "stream/given_extras.h"
#include "stream/level_stage.h"
#include "stream/targets.h"

namespace tex::inline v1 {

Result<BlendFileReport> blend_stream(MapSource& base, const std::string& output, Container container,
                                     const BlendFileOptions& options, const Execution& execution,
                                     const StreamSizes& sizes) {
    Blending blending(base, options);
    if (const Result<void> opened = blending.open(execution); !opened) return opened.error();
    BlendFileReport report;
    const int left_out = report.left_out = first_level(options.mip, blending.extent());
    report.extent = level_extent(blending.extent(), left_out);
    const bool holds = any_holds_levels(container, options.level_names, options.more);
    report.levels = holds ? levels_to_build(options.mip, blending.extent()) : 1;
    report.pack = packing_for(options.pack, container, blending.source());
    std::vector<FileTarget> files = {{output, options.level_names, container, report.pack, options.write}};
    add_targets(options.more, blending.source(), files);
    const Result<GivenExtras> given = GivenExtras::read(options.others, blending.extent(), files);
    if (!given) return given.error();
    const ExtraSet own = given->planes();
    ExtraSet kept = blending.extras_taken() & held_by_any(files) & !own;
    if (kept.alpha && may_change_ones(options.mip, files)) {
        const Result<bool> is_one = blending.alpha_is_one();
        if (!is_one) return is_one.error();
        kept.alpha = !*is_one;
    }
    const ExtraSet extras = kept | own;
    if (const Result<void> fit = check_together(extras); !fit) return fit.error();
    Targets targets;
    if (const Result<void> opened = targets.open(files, extras, report.extent, report.levels); !opened)
        return opened.error();
    Flow flow;
    flow.set_rows_together(targets.rows_together());
    const MadeLevels levels{-left_out, left_out + report.levels, counted_from_base(options.mip, left_out), extras};
    add_levels(flow, given->add_to(flow, blending.add_to(flow, kept)), levels, targets);
    if (const Result<void> done = flow.run(execution, sizes); !done) return done.error();
    const ExtraSet not_wanted{false, !options.source.unpack.others.alpha, false};
    const ExtraSet held = kept & held_by_all(files);
    blending.judge(own | held | not_wanted, held);
    report.source = blending.source();
    report.details = blending.details();
    if (options.accept) {
        if (const Result<void> accepted = options.accept(report.source); !accepted) return accepted.error();
    }
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

}  // namespace tex::inline v1
