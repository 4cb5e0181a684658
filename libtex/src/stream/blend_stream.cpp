// SPDX-License-Identifier: Apache-2.0

#include "stream/blend_stream.h"

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include <tex/mip_chain.h>

#include "rows/mip_rows.h"
#include "stream/blending.h"
#include "stream/level_stage.h"
#include "stream/shared_writer.h"

namespace tex {
namespace {

class BlendRun {
public:
    BlendRun(Blending& blending, const std::string& output, Container container, const BlendFileOptions& options,
             const StreamSizes& sizes)
        : blending_(blending), output_(output), container_(container), options_(options), sizes_(sizes) {}

    // Reads the maps once. Returns false if the layout of one was not what it seemed.
    Result<bool> run(const Execution& execution);

    [[nodiscard]] const BlendFileReport& report() const { return report_; }

private:
    void describe();
    Result<std::unique_ptr<StripWriter>> open_writer() const;
    Result<void> stream(const Execution& execution);

    Blending& blending_;
    const std::string& output_;
    const Container container_;
    const BlendFileOptions& options_;
    const StreamSizes& sizes_;
    std::unique_ptr<StripWriter> writer_;
    int first_ = 0;  // the first level that is kept
    BlendFileReport report_;
};

// Finds out what to write.
void BlendRun::describe() {
    first_ = first_level(options_.mip, blending_.extent());
    report_.extent = level_extent(blending_.extent(), first_);
    report_.source = blending_.source();
    report_.details = blending_.details();
    const bool holds = any_holds_levels(container_, options_.level_names, options_.more);
    report_.levels = holds ? levels_to_build(options_.mip, blending_.extent()) : 1;
    report_.pack = packing_for(options_.pack, container_, report_.source);
}

Result<std::unique_ptr<StripWriter>> BlendRun::open_writer() const {
    std::vector<FileTarget> targets = {{{output_, options_.level_names}, container_, report_.pack, options_.write}};
    add_targets(options_.more, report_.source, targets);
    return open_targets(targets, report_.extent, report_.levels);
}

Result<void> BlendRun::stream(const Execution& execution) {
    const Result<std::unique_ptr<Blending::Reading>> reading = blending_.read(execution);
    if (!reading) return reading.error();
    Blending::Reading& maps = **reading;
    const int levels_made = first_ + report_.levels;
    RowStream stream(*maps.rows, blending_.path(), -first_, levels_made, *writer_, execution, sizes_);
    BlendStage blended(maps.maps, maps.in_step, stream.sink());
    constexpr int kFromTheTop = 0;
    LevelStage levels(blending_.extent(), levels_made, kFromTheTop, counted_from_base(options_.mip, first_),
                      stream.strips());
    return stream.run(blended, levels);
}

Result<bool> BlendRun::run(const Execution& execution) {
    if (const Result<void> ready = blending_.prepare(); !ready) return ready.error();
    describe();
    Result<std::unique_ptr<StripWriter>> opened = open_writer();
    if (!opened) return opened.error();
    // The old writer is closed only now, after the new one is open: a reader of a FIFO takes the end of the last writer
    // for the end of the file.
    writer_ = std::move(*opened);
    if (const Result<void> streamed = stream(execution); !streamed) return streamed.error();
    if (!blending_.was_right()) return false;
    blending_.judge(report_.source, report_.details);
    if (const Result<void> committed = writer_->commit(); !committed) return committed.error();
    report_.bytes = writer_->file_bytes();
    report_.rdo = writer_->rdo();
    return true;
}

Result<BlendFileReport> run_blend(Blending& blending, const std::string& output, Container container,
                                  const BlendFileOptions& options, const Execution& execution,
                                  const StreamSizes& sizes) {
    double told = 0.0;  // a new reading does not move progress backwards
    Execution onward{execution.threads, {}};
    if (execution.progress) {
        onward.progress = [&](double fraction) { return execution.progress(told = std::max(told, fraction)); };
    }
    if (const Result<void> opened = blending.open(onward); !opened) return opened.error();
    BlendRun blend(blending, output, container, options, sizes);
    while (true) {
        const Result<bool> done = blend.run(onward);
        if (!done) return done.error();
        if (*done) return blend.report();
        if (const Result<void> again = blending.open_again(); !again) return again.error();
    }
}

}  // namespace

Result<BlendFileReport> blend_stream(const std::string& input, const std::string& output, Container container,
                                     const BlendFileOptions& options, const Execution& execution,
                                     const StreamSizes& sizes) {
    Blending blending(input, options);
    return run_blend(blending, output, container, options, execution, sizes);
}

Result<BlendFileReport> blend_stream(MapSource& base, const std::string& output, Container container,
                                     const BlendFileOptions& options, const Execution& execution,
                                     const StreamSizes& sizes) {
    Blending blending(base, options);
    return run_blend(blending, output, container, options, execution, sizes);
}

}  // namespace tex
