// SPDX-License-Identifier: Apache-2.0

#include "stream/blend_stream.h"

#include <algorithm>
#include <deque>
#include <memory>
#include <utility>
#include <vector>

#include "rows/mip_rows.h"
#include "stream/blend_stage.h"
#include "stream/joined_rows.h"
#include "stream/level_stage.h"
#include "stream/map_file.h"
#include "stream/placed_map.h"
#include "stream/strip_writer.h"
#include "threads/parallel.h"

namespace tex {
namespace {

// One of the maps: its file, its place, and the rows that are needed at a time if its rows keep in step with those of
// the result.
struct Input {
    Input(const std::string& path, const SourceOptions& options) : file(path, options) {}

    MapFile file;
    UvMap map;
    Wrap wrap_x = Wrap::repeat;
    Wrap wrap_y = Wrap::repeat;
    std::optional<RowsInStep> step;  // empty: the whole map is held in memory
    std::optional<YWitness> witness;
};

class Blending {
public:
    Blending(const std::string& input, const std::string& output, Container container, const BlendFileOptions& options,
             const StreamSizes& sizes)
        : output_(output), container_(container), options_(options), sizes_(sizes),
          base_(inputs_.emplace_back(input, options.source)) {}

    // Opens all files and reads the maps that are held in memory.
    Result<void> open(const Execution& execution);
    // Reads the other maps once. Returns false if the layout of one was not what it seemed.
    Result<bool> run(const Execution& execution);
    // Prepares for another reading.
    Result<void> open_again();

    [[nodiscard]] const BlendFileReport& report() const { return report_; }

private:
    Result<void> settle(Input& input, const Execution& execution);
    Result<void> prepare();
    Result<std::unique_ptr<StripWriter>> open_writer() const;
    Result<void> stream(const Execution& execution);
    Result<PlacedMap> place(Input& input, std::deque<ArrivingMap>& arriving, const Execution& execution);

    const std::string& output_;
    const Container container_;
    const BlendFileOptions& options_;
    const StreamSizes& sizes_;
    std::deque<Input> inputs_;  // the base, then the details
    Input& base_;
    std::vector<Layer> layers_;
    std::unique_ptr<StripWriter> writer_;
    BlendFileReport report_;
};

// Whether the rows of a detail can keep in step, as far as that can be decided without its extent.
bool lies_flat(const Layer& layer) {
    return layer.tiling_x == 1.0f && layer.tiling_y == 1.0f && layer.offset_y == 0.0f && layer.rotation == 0.0f;
}

// Decides whether a map is read in step or held in memory.
Result<void> Blending::settle(Input& input, const Execution& execution) {
    if (const RowSource* rows = input.file.rows()) {
        input.step = rows_in_step(rows->extent(), report_.extent, input.map, input.wrap_x, input.wrap_y);
    }
    return input.step ? Result<void>() : input.file.hold(false, execution);
}

Result<void> Blending::open(const Execution& execution) {
    const Execution silent{execution.threads, {}};
    if (Result<void> opened = base_.file.open(); !opened) return opened;
    report_.extent = options_.blend.extent;
    if (report_.extent == Extent{} && base_.file.rows() != nullptr) report_.extent = base_.file.rows()->extent();
    if (report_.extent == Extent{}) {
        if (Result<void> held = base_.file.hold(false, silent); !held) return held;
        report_.extent = base_.file.chain().levels.front().extent();
    }
    base_.map = stretch(report_.extent);
    base_.wrap_x = options_.blend.wrap_x;
    base_.wrap_y = options_.blend.wrap_y;
    if (base_.file.chain().levels.empty()) {
        if (Result<void> settled = settle(base_, silent); !settled) return settled;
    }
    for (const LayerFile& layer : options_.layers) {
        if (execution.progress && !execution.progress(0.0)) return Error{ErrorCode::cancelled, {}, "cancelled"};
        Layer& placed = layers_.emplace_back(layer.layer());
        Input& input = inputs_.emplace_back(layer.input, layer.source);
        input.map = uv_map_of(placed, report_.extent);
        input.wrap_x = placed.wrap_x;
        input.wrap_y = placed.wrap_y;
        if (lies_flat(placed)) {
            if (Result<void> opened = input.file.open(); !opened) return opened;
        }
        if (Result<void> settled = settle(input, silent); !settled) return settled;
        if (!layer.mask) continue;
        Result<Plane<float>> mask = layer.mask();
        if (!mask) return mask.error();
        placed.mask = std::move(*mask);
    }
    return {};
}

Result<void> Blending::open_again() {
    for (Input& input : inputs_) {
        if (!input.step) continue;
        if (Result<void> again = input.file.open_again(); !again) return again;
    }
    return {};
}

// Finds out what to read and what to write.
Result<void> Blending::prepare() {
    report_.details.clear();
    for (Input& input : inputs_) {
        if (input.step) {
            if (Result<void> ready = input.file.prepare(); !ready) return ready;
        }
        if (&input != &base_) report_.details.push_back(input.file.info());
    }
    report_.source = base_.file.info();
    report_.levels = holds_levels(container_, options_.level_names) ? levels_to_build(options_.mip, report_.extent) : 1;
    if (options_.pack) {
        report_.pack = options_.pack(report_.source);
    } else {
        report_.pack = {default_encoding(container_), report_.source.y_axis};
        report_.pack.y_known = report_.source.y_known;
    }
    return {};
}

Result<std::unique_ptr<StripWriter>> Blending::open_writer() const {
    const OutputNames names{output_, options_.level_names};
    return StripWriter::open(names, container_, packing_of(report_.pack, report_.extent, report_.levels),
                             options_.write);
}

Result<PlacedMap> Blending::place(Input& input, std::deque<ArrivingMap>& arriving, const Execution& execution) {
    if (!input.step) return place_chain(input.file.chain(), input.map, input.wrap_x, input.wrap_y, execution);
    MapFile& file = input.file;
    input.witness.reset();
    if (file.doubts_y()) input.witness.emplace(report_.extent);
    ArrivingMap& map = arriving.emplace_back(file.texture(), report_.extent, file.sources(), file.rule(), file.finder(),
                                             input.witness ? &*input.witness : nullptr, *input.step);
    return PlacedMap{nullptr,     [&map](int j) { return map.row(j); }, report_.extent, input.map, input.wrap_x,
                     input.wrap_y};
}

Result<void> Blending::stream(const Execution& execution) {
    std::deque<ArrivingMap> arriving;
    std::vector<ArrivingMap*> in_step;
    std::vector<JoinedRows::Member> members;
    PlacedMaps maps{{}, {}, options_.blend, report_.extent};
    for (std::size_t k = 0; k < inputs_.size(); ++k) {
        Result<PlacedMap> placed = place(inputs_[k], arriving, execution);
        if (!placed) return placed.error();
        if (k == 0) maps.base = *placed;
        if (k > 0) maps.layers.push_back({layers_[k - 1], *placed});
        if (!inputs_[k].step) continue;
        in_step.push_back(&arriving.back());
        members.push_back({inputs_[k].file.rows(), &inputs_[k].file.path()});
    }
    // The planes of each map follow those of the maps before it.
    std::size_t planes = 0;
    for (Input& input : inputs_) {
        if (!input.step) continue;
        for (std::size_t& plane : input.file.texture().planes) plane += planes;
        planes += input.file.rows()->names().size();
    }
    JoinedRows rows(report_.extent, std::move(members));
    RowStream stream(rows, base_.file.path(), 0, report_.levels, *writer_, execution, sizes_);
    BlendStage blended(maps, std::move(in_step), stream.sink());
    constexpr int kFromTheTop = 0;
    LevelStage levels(report_.extent, report_.levels, kFromTheTop, options_.mip, stream.strips());
    return stream.run(blended, levels);
}

Result<bool> Blending::run(const Execution& execution) {
    if (const Result<void> ready = prepare(); !ready) return ready.error();
    Result<std::unique_ptr<StripWriter>> opened = open_writer();
    if (!opened) return opened.error();
    // The old writer is closed only now, after the new one is open: a reader of a FIFO takes the end of the last writer
    // for the end of the file.
    writer_ = std::move(*opened);
    if (const Result<void> streamed = stream(execution); !streamed) return streamed.error();
    bool right = true;
    for (Input& input : inputs_) right = input.file.was_right() && right;
    if (!right) return false;
    for (std::size_t k = 0; k < inputs_.size(); ++k) {
        SourceInfo& info = k == 0 ? report_.source : report_.details[k - 1];
        if (inputs_[k].witness) info.y_doubtful = inputs_[k].witness->contradicts();
    }
    if (const Result<void> committed = writer_->commit(); !committed) return committed.error();
    report_.bytes = writer_->file_bytes();
    return true;
}

}  // namespace

Result<BlendFileReport> blend_stream(const std::string& input, const std::string& output, Container container,
                                     const BlendFileOptions& options, const Execution& execution,
                                     const StreamSizes& sizes) {
    double told = 0.0;  // a new reading does not move progress backwards
    Execution onward{execution.threads, {}};
    if (execution.progress) {
        onward.progress = [&](double fraction) { return execution.progress(told = std::max(told, fraction)); };
    }
    Blending blending(input, output, container, options, sizes);
    if (const Result<void> opened = blending.open(onward); !opened) return opened.error();
    while (true) {
        const Result<bool> done = blending.run(onward);
        if (!done) return done.error();
        if (*done) return blending.report();
        if (const Result<void> again = blending.open_again(); !again) return again.error();
    }
}

}  // namespace tex
